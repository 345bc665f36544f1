"""What all rooms share: units, errors, arrays, files; nothing of lubrication."""
