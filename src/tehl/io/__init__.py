"""Files: cases in, results in and out, exports."""
