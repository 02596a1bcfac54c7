"""Sweeps: a scene rendered with many settings, each timed and held against a traced reference.

`abbe sweep` runs it: python3 -m abbe.sweep --help. docs/trade.md says what is measured.
"""
