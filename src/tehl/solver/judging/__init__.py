"""What a film is worth: its errors, whether it is valid, what to try instead."""
