"""Translates the plain subset of Python, in which the physics is written, to readable C99.

The subset: floats, ints, bools, tuples of fixed length, rows of floats that are indexed (pointers in C), `math`, calls
of functions of the subset by their names or on constants, if, while, for over a range. A name has one type. A function
is translated for the types of its arguments. Arguments that are not numbers (a SignalPath, its stages) and whole
numbers are constants of a translation: a loop over a constant tuple is unrolled, and a function is translated anew for
each constant. Anything else raises Unsupported with its place: nothing is guessed.

A tuple becomes a struct: of equal elements with an array v, else with members a, b, c, or the names of a NamedTuple.
"""
