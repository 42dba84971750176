"""The article of Hull, Wang & Moore (1996) computed again: its claims, and its figures 1 to 3."""

from .figures import draw
from .outcomes import Outcome, check_article, summary, to_csv, to_json, to_table

__all__ = ["Outcome", "check_article", "draw", "summary", "to_csv", "to_json", "to_table"]
