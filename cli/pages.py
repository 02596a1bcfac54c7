#!/usr/bin/env python3
"""pages.py ABBE FOLDER: manual pages, abbe.bash and _abbe, made from what the program's help says.

What the program prints for --help is all that this knows of its commands and options.
"""
import os
import re
import subprocess
import sys

abbe, folder = sys.argv[1:]
version = subprocess.run([abbe, "--version"], check=True, capture_output=True, text=True).stdout.split()[1]
OPTION = re.compile(r"  (?:-(\S), |    )--([a-z0-9-]+)(\[?=\S+)? *(.*)")
ROW = re.compile(r"  ([a-z-]+) {2,}(.*)")
STATUS = ".SH EXIT STATUS\n0 done, 1 failed, 2 used wrongly, 3 out of tolerance.\n.SH SEE ALSO\n.BR %s (1)\n"


def said(*words):
    environment = dict(os.environ, ARGP_HELP_FMT="rmargin=5000", LC_ALL="C.UTF-8")
    return subprocess.run([abbe, *words, "--help"], check=True, capture_output=True, text=True,
                          env=environment).stdout


def roff(text):
    """What roff would obey, as what it shows. A list may break behind its commas."""
    for sign, shown in (("\\", "\\e"), ("-", "\\-"), ("~", "\\(ti"), ("^", "\\(ha"), ("`", "\\(ga")):
        text = text.replace(sign, shown)
    text = re.sub(r",(?=[^ \n])", r",\\:", text)
    return re.sub(r"(?m)^(?=[.'])", r"\\&", text)


def paragraphs(text):
    """Lines that are indented by two are shown as they are."""
    out, shown = [], False
    for line in re.sub(r"\n\n+(?=Examples:)", "\n", text.strip("\n")).split("\n"):
        if shown != line.startswith("  "):
            shown = not shown
            out.append(".RS\n.EX" if shown else ".EE\n.RE")
        out.append(".SH EXAMPLES" if line == "Examples:" else roff(line) if line else ".PP")
    return "\n".join(out + [".EE\n.RE"] * shown) + "\n"


class Page:
    """What the help of a command or verb has: uses, description, options with headings, notes."""

    def __init__(self, *words):
        text = said(*words)
        self.words, self.uses, self.options = words, [], []
        lines = text.split("\n")
        while lines and re.match(r"Usage: |  or:  ", lines[0]):
            self.uses.append(lines.pop(0)[7:])
        first = next(i for i, line in enumerate(lines) if re.match(OPTION, line) or line.startswith(" "))
        last = next(i for i, line in enumerate(lines) if "--version" in line)
        self.about = "\n".join(lines[:first])
        for line in lines[first:last + 1]:
            found = re.match(OPTION, line)
            if found:
                self.options.append([found[1], found[2], found[3] or "", found[4]])
            elif line.startswith("    "):
                self.options[-1][3] += " " * bool(self.options[-1][3]) + line.strip()
            elif line.strip():
                self.options.append([None, None, line.strip(), ""])
        self.notes = re.sub(r"^\n*Mandatory or optional arguments.*\n", "", "\n".join(lines[last + 1:]))

    def roff(self, summary):
        name = " ".join(("abbe",) + self.words)
        out = [head(name, summary), ".SH SYNOPSIS\n"]
        for i, use in enumerate(self.uses):
            rest = use[len(name):].replace(" [OPTION...]", "").strip()
            out.append(".br\n" * (i > 0) + f".B {name}\n[\\fIOPTION\\fR…] {roff(rest)}\n")
        out.append(".SH DESCRIPTION\n" + paragraphs(self.about) + ".SH OPTIONS\n")
        for short, long, value, what in self.options:
            if long is None:
                out.append(f".SS {roff(value)}\n")
                continue
            value = re.sub(r"^(\[?=)(.*?)(\]?)$", lambda m: m[1] + "\\fI" + roff(m[2]) + "\\fR" + m[3], value)
            dash = f"\\fB\\-{short}\\fR, " if short else ""
            out.append(f".TP\n{dash}\\fB\\-\\-{roff(long)}\\fR{value}\n{roff(what)}\n")
        if self.notes.strip():
            out.append(".SH NOTES\n" * (not self.notes.strip().startswith("Examples:")) + paragraphs(self.notes))
        return "".join(out) + STATUS % "abbe"

    def names(self, wanted=lambda value: True):
        return [name for short, long, value, what in self.options if long is not None and wanted(value)
                for name in (["--" + long, "-" + short] if short else ["--" + long])]

    def bash(self):
        needed = [re.compile(r"=.*(FILE|FOLDER|TABLE)"), re.compile(r"=(?!.*(FILE|FOLDER|TABLE))")]
        files, values = (" ".join(self.names(kind.match)) for kind in needed)
        names = [name for name in self.names() if name not in ("--help", "--usage", "--version")]
        options = " ".join(["--help", "--usage", "--version"] + names)
        return f"  '{' '.join(self.words)}')\n    options='{options}'\n    files=' {files} '\n    values=' {values} ' ;;\n"

    def zsh(self):
        out = [f"  ('{' '.join(self.words)}')\n    _arguments -s"]
        for short, long, value, what in self.options:
            if long is None:
                continue
            given = re.sub(r"^\[=(.*)\]$|^=", r"\1", value)
            if long in ("help", "usage", "version"):
                out.append(f"'(- *)--{long}[{quoted(what)}]'")
                continue
            ending = ("::" if value.startswith("[") else ":") + quoted(given) + (
                ":_files" if re.search("FILE|FOLDER|TABLE", given) else ": ") if given else ""
            plus, equals = ("+", "=") if given else ("", "")
            star = "*" * ("repeat" in what)
            flag = f"'(-{short} --{long})'{{-{short}{plus},--{long}{equals}}}'" if short else f"'{star}--{long}{equals}"
            out.append(f"{flag}[{quoted(what)}]{ending}'")
        return " \\\n      ".join(out + ["'*:file:_files' ;;\n"])


def quoted(text):
    """Inside of '…', where _arguments and _describe take some signs for their own."""
    return re.sub(r"([\\\[\]:])", r"\\\1", text).replace("'", "'\\''")


def head(name, summary):
    dashed = roff(name.replace(" ", "-"))
    return (f".TH {dashed.upper()} 1 \"\" \"abbe {version}\" \"Abbe\"\n.ad l\n"
            f".SH NAME\n{dashed} \\- {roff(summary)}\n")


def listed(name, rows):
    return "".join(f".TP\n\\fB{roff(name)}\\-{roff(row)}\\fR(1)\n{roff(summary)}\n" for row, summary in rows)


def write(name, text):
    with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
        file.write(text)


whole = subprocess.run([abbe, "help"], check=True, capture_output=True, text=True).stdout
first_steps = re.search(r"First steps:\n(.*?)\nStones and", whole, re.S)[1]
commands = re.findall(ROW, whole[whole.index("Stones and"):])
python = re.search(r"\n\n(In Python.*?)\n\n", whole, re.S)[1].split("\n", 1)[1]
verbs, pages = {}, []
for command, summary in commands:
    text = said(command)
    if not text.startswith("usage:"):
        pages.append((Page(command), summary))
        continue
    verbs[command] = re.findall(ROW, text[:text.index("\nExamples:")])
    pages += [(Page(command, verb), what) for verb, what in verbs[command]]
    examples = re.search(r"\nExamples:\n(.*?)\n\n", text, re.S)[1]
    write(f"abbe-{command}.1", head(f"abbe {command}", summary) +
          f".SH SYNOPSIS\n.B abbe {command}\n\\fIVERB\\fR [\\fIOPTION\\fR…] [\\fINAME\\fR…]\n.SH VERBS\n" +
          listed(f"abbe-{command}", verbs[command]) + ".SH EXAMPLES\n" + paragraphs(examples) + STATUS % "abbe")
for page, summary in pages:
    write("-".join(("abbe",) + page.words) + ".1", page.roff(summary))
write("abbe.1", head("abbe", "spectral dispersion caustics") +
      ".SH SYNOPSIS\n.B abbe\n\\fICOMMAND\\fR [\\fIOPTION\\fR…] [\\fIFILE\\fR…]\n"
      ".SH DESCRIPTION\nAbbe renders what light does in gems, prisms and glass, traces a reference with standard "
      "errors, compares the two, and keeps tables of materials and designs of gems.\n.SH COMMANDS\n" +
      listed("abbe", commands) + ".SH EXAMPLES\n" + paragraphs(first_steps) +
      "Scenes that are not where they are said to be are taken from those that came with the program.\n"
      ".SH IN PYTHON\n" + paragraphs(python) + STATUS % "abbe-render")

BASH = r"""# bash completion of abbe, made from its help
_abbe() {
  local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD-1]}
  local first=1 command verbs= options= files= values=
  COMPREPLY=()
  # '=' is a word of its own
  if [ "$cur" = = ]; then
    cur=
  elif [ "$prev" = = ]; then
    prev=${COMP_WORDS[COMP_CWORD-2]}
  fi
  [ "${COMP_WORDS[1]}" = help ] && first=2
  if [ "$COMP_CWORD" -le "$first" ]; then
    COMPREPLY=($(compgen -W "@commands@ help --help --version" -- "$cur"))
    return
  fi
  command=${COMP_WORDS[first]}
  case $command in
@verbs@  esac
  if [ -n "$verbs" ]; then
    if [ "$COMP_CWORD" -eq $((first + 1)) ]; then
      COMPREPLY=($(compgen -W "$verbs --help" -- "$cur"))
      return
    fi
    command="$command ${COMP_WORDS[first+1]}"
  fi
  [ "$first" -eq 1 ] || return 0
  case $command in
@options@  esac
  if [[ $values == *" $prev "* ]]; then
    return 0
  elif [[ $files != *" $prev "* && $cur == -* ]]; then
    COMPREPLY=($(compgen -W "$options" -- "$cur"))
  else
    compopt -o filenames 2>/dev/null
    mapfile -t COMPREPLY < <(compgen -f -- "$cur")
  fi
}
complete -F _abbe abbe
"""
ZSH = r"""#compdef abbe
# zsh completion of abbe, made from its help
_abbe() {
  local -a commands verbs
  commands=(
@commands@    'help:all commands, or one of them'
  )
  local asked=
  if [[ $words[2] == help && CURRENT -gt 2 ]]; then
    asked=1
    shift words
    (( CURRENT-- ))
  fi
  if (( CURRENT == 2 )); then
    _describe command commands
    return
  fi
  local command=$words[2]
  case $command in
@verbs@  esac
  if (( $#verbs )); then
    if (( CURRENT == 3 )); then
      _describe verb verbs
      return
    fi
    command="$command $words[3]"
    shift words
    (( CURRENT-- ))
  fi
  [[ -n $asked ]] && return
  shift words
  (( CURRENT-- ))
  case $command in
@options@  esac
}
_abbe "$@"
"""


def filled(text, **parts):
    for name, part in parts.items():
        text = text.replace(f"@{name}@", part)
    return text


def described(rows):
    return "".join(f"    '{row}:{quoted(summary)}'\n" for row, summary in rows)


write("abbe.bash", filled(
    BASH, commands=" ".join(name for name, summary in commands),
    verbs="".join(f"  {name}) verbs='{' '.join(verb for verb, what in rows)}' ;;\n" for name, rows in verbs.items()),
    options="".join(page.bash() for page, summary in pages)))
write("_abbe", filled(
    ZSH, commands=described(commands),
    verbs="".join(f"  ({name}) verbs=(\n{described(rows)}  ) ;;\n" for name, rows in verbs.items()),
    options="".join(page.zsh() for page, summary in pages)))
