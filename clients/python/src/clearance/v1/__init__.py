"""Messages and stubs, generated from proto/clearance/v1 by regenerate.py. The comments there say what they mean."""
