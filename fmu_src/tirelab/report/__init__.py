"""A diagnosis as one page to read: `write_report`."""

from .page import write_report

__all__ = ["write_report"]
