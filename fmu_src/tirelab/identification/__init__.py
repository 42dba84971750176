"""Recordings in, a tire out: the identification of Hull, Wang & Moore (1996), and one joint fit beyond it.

Stage 1 takes A and B of each surface by least RMSE of the force (`power_fit`), stage 2 the constants C, D, E from these
(`two_stage`). Then all samples of all recordings are fitted together (`joint`), with uncertainties from the measured
noise (`noise`) and the statement of what the surfaces cannot determine (`intervals`, `result`).
"""
