"""What is measured and decided in three dimensions."""
