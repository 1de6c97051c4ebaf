"""What each effect of a real drive does to the zoom spectrum: a page with a picture, made by ``hd-monitor gallery``."""
