"""page.py PAGE [--update]: runs a page's Python sessions, blocks indented by four spaces whose lines
begin with >>> or ..., in one interpreter, and holds what they print against the page. --update
prints the page with what they print now."""
import doctest
import re
import sys


def sessions(text):
    """The indented blocks that hold a session, with the line that each begins at."""
    block, begin = [], 0
    for number, line in enumerate(text.split("\n") + [""]):
        if line.startswith("    "):
            begin = begin if block else number
            block.append(line[4:])
        elif block:
            if any(one.startswith(">>> ") for one in block):
                yield begin, "\n".join(block) + "\n"
            block = []


class Keeper(doctest.DocTestRunner):
    """Keeps what each example prints."""

    def __init__(self):
        super().__init__(optionflags=doctest.ELLIPSIS, verbose=False)
        self.got = {}

    def report_success(self, out, test, example, got):
        self.got[test.lineno + example.lineno, example.source] = got

    def report_failure(self, out, test, example, got):
        self.got[test.lineno + example.lineno, example.source] = got
        super().report_failure(out, test, example, got)


def main():
    path = sys.argv[1]
    with open(path, encoding="utf-8") as file:
        text = file.read()
    parser, runner, names, count = doctest.DocTestParser(), Keeper(), {}, 0
    lines = text.split("\n")
    replace = []
    for begin, block in sessions(text):
        test = parser.get_doctest(block, names, path, path, begin)
        count += len(test.examples)
        runner.run(test, clear_globs=False, out=None if len(sys.argv) < 3 else lambda _: None)
        names = test.globs
        for example in test.examples:
            first = begin + example.lineno + example.source.count("\n")
            length = example.want.count("\n")
            got = runner.got.get((begin + example.lineno, example.source), example.want)
            if "..." not in example.want:
                replace.append((first, length, ["    " + one for one in got.split("\n")[:-1]]))
    if len(sys.argv) > 2:
        for first, length, got in reversed(replace):
            lines[first:first + length] = got
        print("\n".join(lines), end="")
        return 0
    if count < 20:
        print(f"{path} shows only {count} lines of Python")
        return 1
    print(f"{count} lines of {re.sub('.*/', '', path)} run, {runner.failures} of them wrongly")
    return runner.failures > 0


sys.exit(main())
