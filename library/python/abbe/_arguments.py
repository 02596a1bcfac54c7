"""Command lines of the commands in Python: readers of words, and errors as those in C have them."""
import argparse
import difflib
import sys


class Parser(argparse.ArgumentParser):
    def error(self, message):
        sys.stderr.write(f"{self.prog}: {message}\nTry '{self.prog} --help'.\n")
        sys.exit(2)

    def known(self, words=None):
        """The arguments (None: the command line's); an option that is none is told with the nearest."""
        q, others = self.parse_known_intermixed_args(words)
        for other in others:
            options = [name for action in self._actions for name in action.option_strings]
            self.error(f"there is no option '{other}'{near(other.partition('=')[0], options)}")
        return q


def near(text, names):
    best = difflib.get_close_matches(text, names, 1)
    return f"; did you mean '{best[0]}'?" if best else ""


def count(least, most):
    def read(text):
        try:
            value = int(text)
        except ValueError:
            raise argparse.ArgumentTypeError(f"'{text}' is not a whole number") from None
        if not least <= value <= most:
            raise argparse.ArgumentTypeError(f"{text} is not from {least} to {most}")
        return value
    return read


def choice(*names):
    def read(text):
        if text not in names:
            raise argparse.ArgumentTypeError(f"'{text}' is none of {', '.join(names)}"
                                             + near(text, names))
        return text
    return read


def target(*ends):
    def read(text):
        if not text.lower().endswith(ends):
            raise argparse.ArgumentTypeError(f"'{text}' does not end with {' or '.join(ends)}")
        return text
    return read
