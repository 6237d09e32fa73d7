"""Inventories: many objects of one table under the records of their sites, ranked by how probably they overturn."""
