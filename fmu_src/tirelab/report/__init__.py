"""A diagnosis for a reader: the page, the terminal, the pictures and their words."""
