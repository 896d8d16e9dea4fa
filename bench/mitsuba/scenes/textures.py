"""Glass, sheets and gaps."""
