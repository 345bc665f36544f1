"""What people read of a case before the solve and of a result: texts and HTML pages."""
