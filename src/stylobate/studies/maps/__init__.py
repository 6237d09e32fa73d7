"""Maps over two or more numbers: outcomes, basins and attractors, integrity and uncertainty."""
