"""Pictures of the figures: from stored runs to a matplotlib figure."""
