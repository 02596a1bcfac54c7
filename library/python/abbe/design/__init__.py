"""`abbe design`: panes that throw a picture, prisms with a wanted fan, pairs without colour.

python3 -m abbe.design is the same.
"""
