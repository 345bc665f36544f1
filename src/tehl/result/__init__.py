"""What a solve gives: fields and numbers of a steady or transient film; frozen."""
