"""Animations: the motion of a column as numbers, GIF, MP4 or self-contained web page."""
