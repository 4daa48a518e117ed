"""Section 2 of the paper: the front, and circles placed at it."""
