"""Puts this folder on the path, so that tests of effects find `driving`."""
