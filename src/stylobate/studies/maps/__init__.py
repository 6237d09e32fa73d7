"""What happens over a plane of numbers: outcomes, basins and attractors, integrity and uncertainty."""
