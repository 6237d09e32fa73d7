"""Models of one column side by side."""
