"""Worlds wider than a catalogue of tire physics: loud, press, foreign, outside and beside.

They are drawn only where they are asked for by name, in streams of random numbers of their own.
"""
