"""What the command line answers, and that nothing of a user's is overwritten.
Usage: command_line.py IMPLAM FOLDER"""

import os
import pty
import select
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "regress"))
from solver_runs import read_history, require

EXIT_USAGE, EXIT_FILES = 1, 4


def answer(implam, *words, cwd=None, code=0):
    """Return what the program prints, standard error included; the exit code must be as expected."""
    done = subprocess.run([implam, *words], cwd=cwd, stdin=subprocess.DEVNULL, capture_output=True, text=True,
                          timeout=400, check=False)
    told = done.stdout + done.stderr
    require(done.returncode == code, f"implam {' '.join(words)}: exit code {done.returncode}\n{told}")
    return told


def check_help(implam):
    """Help by all its names; without a word it comes too, with the code of misuse."""
    page = answer(implam, "--help")
    require(page == answer(implam, "-h") == answer(implam, "help"), "-h, help and --help differ.")
    require(max(map(len, page.splitlines())) <= 96, "A line of the help is longer than 96 characters.")
    for word in ("check", "explain", "restart", "new", "--output", "--wall-limit", "75", "USR1"):
        require(word in page, f"The help doesn't speak of {word}.")
    bare = answer(implam, code=EXIT_USAGE)
    require(bare.startswith(page) and "No deck given" in bare, "`implam` alone doesn't help.")
    print("help: done")


def check_explain(implam):
    """One key by each way to write it."""
    expected = answer(implam, "explain", "plate%length")
    require("length" in expected, expected)
    for words in (["explain", "plate.length"], ["explain", "plate", "length"], ["explain", "&plate", "length"],
                  ["explain", "plate length"], ["help", "plate", "length"], ["help", "plate.length"]):
        require(answer(implam, *words) == expected, f"implam {' '.join(words)} differs from explain plate%length.")
    slip = answer(implam, "explain", "plate", "lenght", code=EXIT_USAGE)
    require("did you mean length" in slip, "No help with a slip.")
    require("one deck" in answer(implam, "explain", "plate", "length", "edges", code=EXIT_USAGE), "Three topics pass.")
    print("explain: done")


def check_pages(implam, folder):
    """The manual page has every key; bash completes commands, groups, keys and decks."""
    page = answer(implam, "man")
    for line in answer(implam, "explain", "time").splitlines()[1::2]:
        require(f".B {line.split()[0]}\n" in page, f"The manual page lacks {line.split()[0]} of &time.")
    require("mandoc" not in page and all(line[:1] != "'" for line in page.splitlines()), "A line begins with a macro.")
    if shutil.which("groff"):
        done = subprocess.run(["groff", "-man", "-Tutf8", "-ww"], input=page, capture_output=True, text=True,
                              check=True)
        require(not done.stderr, done.stderr)
    (folder / "implam.bash").write_text(answer(implam, "completion", "bash"), encoding="utf-8")
    (folder / "plate.nml").touch()
    cases = {"implam exp": "explain", "implam explain plate.le": "plate.length", "implam explain lamin": "laminate",
             "implam --wall": "--wall-limit", "implam check pl": "plate.nml", "implam completion z": "zsh"}
    for typed, expected in cases.items():
        script = (f"source implam.bash; COMP_WORDS=({typed}); COMP_CWORD=$((${{#COMP_WORDS[@]}}-1)); _implam; "
                  'printf "%s\\n" "${COMPREPLY[@]}"')
        found = subprocess.run(["bash", "-c", script], cwd=folder, capture_output=True, text=True, check=True).stdout
        require(expected in found.split(), f"'{typed}' completes to {found.split()}.")
    require("zsh" in answer(implam, "completion", "fish", code=EXIT_USAGE), "fish is completed.")
    print("pages: done")


def check_zsh(implam, folder):
    """In a zsh as it is started by hand, with the file where zsh looks for completions, the first key completes."""
    if not shutil.which("zsh"):
        print("skipped: zsh isn't installed, its completions are not tried")
        return
    (folder / "_implam").write_text(answer(implam, "completion", "zsh"), encoding="utf-8")
    for typed, expected in (("implam expl", "implam explain "), ("implam explain plate.len", "plate.length "),
                            ("implam check pl", "check plate.nml ")):
        number, terminal = pty.fork()
        if number == 0:
            os.chdir(folder)
            os.environ |= {"TERM": "dumb", "ZDOTDIR": str(folder)}
            os.execvp("zsh", ["zsh", "-f", "-i"])
        os.write(terminal, b"PS1='> '; fpath=($PWD $fpath); autoload -Uz compinit; compinit -u -D; echo re''ady\n")
        said = read_until(terminal, "ready\r")
        os.write(terminal, typed.encode() + b"\t")
        said = read_until(terminal, expected)
        require(expected in said, f"zsh completes '{typed}' to {said!r}.")
        os.kill(number, signal.SIGKILL)
        os.waitpid(number, 0)
        os.close(terminal)
    print("zsh: done")


def read_until(terminal, words):
    """Return what a terminal shows up to some words; all of half a minute if they don't come."""
    said, latest = "", time.monotonic() + 30
    while words not in said and time.monotonic() < latest:
        if select.select([terminal], [], [], 0.1)[0]:
            said += os.read(terminal, 65536).decode(errors="replace")
    return said


def check_new(implam, folder):
    """The deck to start from runs without a warning, grows a delamination, and overwrites nothing."""
    answer(implam, "new", cwd=folder)
    require("no errors" in answer(implam, "check", "impact.nml", cwd=folder), "The starter has faults.")
    before = (folder / "impact.nml").read_bytes()
    require("stays as it is" in answer(implam, "new", cwd=folder, code=EXIT_FILES), "No word of the file there.")
    require((folder / "impact.nml").read_bytes() == before, "`implam new` overwrites.")
    answer(implam, "new", "mine.nml", cwd=folder)
    require((folder / "mine.nml").read_bytes() == before, "The name makes another deck.")
    answer(implam, "new", "no/such/folder.nml", cwd=folder, code=EXIT_FILES)
    told = answer(implam, "impact.nml", cwd=folder)
    require("warning:" not in told, told)
    history = read_history(folder / "results" / "impact_history.csv")
    area = history["delaminated_area"]
    print(f"new: peak force {max(history['force']):.0f} N, area {area[0]:.3g} to {area[-1]:.3g} m2")
    require(area[0] == 0 and area[-1] > 1e-4 and history["force"][-1] == 0, "No growth, or the blow isn't over.")


def main():
    """Check everything in an empty folder."""
    implam, folder = os.path.abspath(sys.argv[1]), Path(sys.argv[2])
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    check_help(implam)
    check_explain(implam)
    check_pages(implam, folder)
    check_zsh(implam, folder)
    check_new(implam, folder)


if __name__ == "__main__":
    main()
