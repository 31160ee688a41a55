"""The texts of the command line; files of the user are not overwritten.
Usage: command_line.py IMPLAM FOLDER"""

import os
import pty
import re
import resource
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

EXIT_USAGE, EXIT_DECK, EXIT_FILES, EXIT_STOPPED = 1, 2, 4, 75


def output_of(implam, *words, cwd=None, code=0):
    """Return what the program prints, standard error included; the exit code must be as expected."""
    done = subprocess.run([implam, *words], cwd=cwd, stdin=subprocess.DEVNULL, capture_output=True, text=True,
                          timeout=400, check=False)
    printed = done.stdout + done.stderr
    require(done.returncode == code, f"implam {' '.join(words)}: exit code {done.returncode}\n{printed}")
    return printed


def check_help(implam):
    """Help by all its names; without arguments it is printed with the exit code of misuse."""
    page = output_of(implam, "--help")
    require(page == output_of(implam, "-h") == output_of(implam, "help"), "-h, help and --help differ.")
    require(max(map(len, page.splitlines())) <= 96, "A line of the help is longer than 96 characters.")
    for word in ("check", "explain", "restart", "new", "--output", "--wall-limit", "75", "USR1"):
        require(word in page, f"The help does not contain {word}.")
    bare = output_of(implam, code=EXIT_USAGE)
    require(bare.startswith(page) and "No deck given" in bare, "`implam` alone does not print the help.")
    print("help: done")


def check_explain(implam):
    """Explain one key, written in every accepted form."""
    expected = output_of(implam, "explain", "plate%length")
    require("length" in expected, expected)
    for words in (["explain", "plate.length"], ["explain", "plate", "length"], ["explain", "&plate", "length"],
                  ["explain", "plate length"], ["help", "plate", "length"], ["help", "plate.length"]):
        require(output_of(implam, *words) == expected, f"implam {' '.join(words)} differs from explain plate%length.")
    slip = output_of(implam, "explain", "plate", "lenght", code=EXIT_USAGE)
    require("did you mean length" in slip, "No suggestion for a misspelt key.")
    three = output_of(implam, "explain", "plate", "length", "edges", code=EXIT_USAGE)
    require("one deck" in three, "Three topics are accepted.")
    column = output_of(implam, "explain", "impactor_velocity")
    require(column == output_of(implam, "explain", "history", "impactor_velocity"), "A table and its column differ.")
    for words in (["plate", "length"], ["length"]):
        slip = output_of(implam, "explain", *words, "--markdown", code=EXIT_USAGE)
        require("--markdown prints tables of groups" in slip, slip)
    slip = output_of(implam, "explain", "history", "vorce", code=EXIT_USAGE)
    require("There is no vorce in the results; `implam explain history` lists" in slip, slip)
    print("explain: done")


def check_slips(implam, folder):
    """A misspelt command, option or topic is reported with the right one; options take values after an equals sign."""
    deck = folder / "small.nml"
    shutil.copy(HERE.parents[1] / "input" / "small" / "cohesive.nml", deck)
    version = output_of(implam, "--version")
    require("To cite: The Implam developers" in version, f"The version does not say how to cite: {version}")
    for word in ("version", "-v"):
        require(output_of(implam, word) == version, f"{word} does not print the version.")
    for words, meant in ((["chek", deck], "did you mean check?"), (["exlpain"], "did you mean explain?"),
                         (["--ouput", "x", deck], "did you mean --output?"),
                         (["--check", deck], "did you mean implam check?"), (["explain", "lnegth"], "mean length?"),
                         (["--verify=1", deck], "takes no value"), (["--wall-limit=", deck], "number of seconds"),
                         (["--no-such=5", deck], "see implam help"),
                         (["nothing", "else"], "one deck")):
        require(meant in output_of(implam, *map(str, words), cwd=folder, code=EXIT_USAGE), f"{words} is not {meant}")
    require("not the deck" in output_of(implam, "restart", str(deck), code=EXIT_FILES), "A deck is accepted.")
    text = deck.read_text(encoding="utf-8")
    for right, slip, meant in (("&plate", "&palte", "&plate"), ("velocity=", "veloctiy=", "velocity"),
                               ("law=", "lwa=", "law")):
        deck.write_text(text.replace(right, slip), encoding="utf-8")
        printed = output_of(implam, "check", str(deck), code=EXIT_DECK)
        require(f"did you mean {meant}?" in printed, printed)
    deck.write_text(text, encoding="utf-8")
    require("no such file" in output_of(implam, "no_deck", cwd=folder, code=EXIT_FILES), "A missing file passes.")
    output_of(implam, str(deck), f"--output={folder / 'equals'}")
    require((folder / "equals" / "cohesive_summary.json").exists(), "--output=DIR has no effect.")
    print("slips: done")


def check_options(implam, folder):
    """Each command refuses all options of others, in one sentence, and does nothing."""
    page = output_of(implam, "help").partition("Options:")[2].partition("Exit codes:")[0]
    takers = {found[1]: found[2].split(", ")
              for found in re.finditer(r"^  (--[\w-]+).*?with ([\w, ]+):", page, re.MULTILINE)}
    takers["-log_view"] = ["run", "restart"]
    require(len(takers) == 10, f"The help names the commands of {takers}.")
    values = {"--rig": "=d7136", "--output": "=away", "--wall-limit": "=9", "--ranks": "=2", "--time": "=1:00:00"}
    deck = "small.nml"
    for verb, files in (("run", [deck]), ("check", [deck]), ("new", ["fresh.nml"]), ("explain", ["plate"]),
                        ("restart", ["away"]), ("queue", ["slurm", deck]), ("completion", ["bash"]), ("man", []),
                        ("version", []), ("help", ["plate"])):
        others = [name for name, verbs in takers.items() if verb not in verbs]
        printed = output_of(implam, verb, *files, *(name + values.get(name, "") for name in others), cwd=folder,
                            code=EXIT_USAGE)
        require(printed.count("\n") == 1 and printed.startswith(f"implam: implam {verb} does not take "), printed)
        for name in others:
            require(f"{name} (an option of {', '.join(takers[name])})" in printed, printed)
    require(not [*folder.glob("away*"), *folder.glob("fresh*"), *folder.glob("*.slurm")], "A file was written.")
    require(output_of(implam, "man", "--chain", "--help") == output_of(implam, "help"), "Options hinder the help.")
    print("options: done")


def check_interrupt(implam, folder):
    """A signal is reported at once, not after the step, which takes 3 s here; a restart names the deck of the run."""
    deck = folder / "long.nml"
    text = (HERE.parents[1] / "input" / "peanut.nml").read_text(encoding="utf-8")
    deck.write_text(text.replace("&case ", "&case refine=2 "), encoding="utf-8")
    with subprocess.Popen([implam, deck, "--output", folder / "long"], stdin=subprocess.DEVNULL,
                          stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as process:
        time.sleep(0.5)
        process.send_signal(signal.SIGINT)
        begun, printed = time.monotonic(), ""
        while "signal received" not in printed and time.monotonic() < begun + 60 and process.poll() is None:
            printed += process.stderr.readline()
        answered = time.monotonic() - begun
        printed += process.communicate(timeout=400)[1]
        ended = time.monotonic() - begun
    require(process.returncode == EXIT_STOPPED, f"{process.returncode}: {printed}")
    require("signal received" in printed and answered < ended / 2, f"After {answered:.1f} of {ended:.1f} s: {printed}")
    options = ("--output", str(folder / "short"), "--wall-limit=1e-3")
    output_of(implam, str(folder / "small.nml"), *options, code=EXIT_STOPPED)
    printed = output_of(implam, "restart", str(folder / "short"))
    require("a deck file changed since then is not read" in printed, printed)
    print(f"interrupt: reported after {answered:.2f} s, ended after {ended:.1f} s")


def check_cut_step(implam, folder):
    """Check and run report in one sentence that the stable step is shorter than the deck's."""
    deck = folder / "cut.nml"
    text = (HERE.parents[1] / "input" / "small" / "cohesive.nml").read_text(encoding="utf-8").partition("&time")[0]
    sentence = "The step of the deck, 1e-5, is longer and is not taken.\n"
    for end, is_cut in (("end=20e-6 step=10e-6", True), ("end=2e-6 step=10e-9", False)):
        deck.write_text(text + f"&time integrator='central_difference' {end} /\n", encoding="utf-8")
        for verb in ("check", "run"):
            printed = output_of(implam, verb, str(deck), cwd=folder)
            require((sentence in printed) == is_cut, f"implam {verb}: {printed}")
    print("cut step: done")


def check_pages(implam, folder):
    """The manual page has every key; bash completes commands, groups, keys and decks."""
    page = output_of(implam, "man")
    # Keys are indented by two blanks, what is said of them by more.
    for line in re.findall(r"^  \w.*", output_of(implam, "explain", "plate"), re.MULTILINE):
        require(f".B {line.split()[0]}\n" in page, f"The manual page lacks {line.split()[0]} of &plate.")
    require("mandoc" not in page and all(line[:1] != "'" for line in page.splitlines()), "A line begins with a macro.")
    if shutil.which("groff"):
        done = subprocess.run(["groff", "-man", "-Tutf8", "-ww"], input=page, capture_output=True, text=True,
                              check=True)
        require(not done.stderr, done.stderr)
    (folder / "implam.bash").write_text(output_of(implam, "completion", "bash"), encoding="utf-8")
    (folder / "plate.nml").touch()
    cases = {"implam exp": "explain", "implam explain plate.le": "plate.length", "implam explain lamin": "laminate",
             "implam --wall": "--wall-limit", "implam check pl": "plate.nml", "implam completion z": "zsh"}
    for typed, expected in cases.items():
        script = (f"source implam.bash; COMP_WORDS=({typed}); COMP_CWORD=$((${{#COMP_WORDS[@]}}-1)); _implam; "
                  'printf "%s\\n" "${COMPREPLY[@]}"')
        found = subprocess.run(["bash", "-c", script], cwd=folder, capture_output=True, text=True, check=True).stdout
        require(expected in found.split(), f"'{typed}' completes to {found.split()}.")
    require("zsh" in output_of(implam, "completion", "fish", code=EXIT_USAGE), "Completions for fish are printed.")
    print("pages: done")


def check_zsh(implam, folder):
    """In an interactive zsh with the file in its folder of completions, the first key completes."""
    if not shutil.which("zsh"):
        print("skipped: zsh is not installed, its completions are not tried")
        return
    (folder / "_implam").write_text(output_of(implam, "completion", "zsh"), encoding="utf-8")
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
    """Return the text of a terminal up to some words, or all text of half a minute if they are missing."""
    said, latest = "", time.monotonic() + 30
    while words not in said and time.monotonic() < latest:
        if select.select([terminal], [], [], 0.1)[0]:
            said += os.read(terminal, 65536).decode(errors="replace")
    return said


def check_compression_of_rig(implam, folder):
    """The compression has the groups of the impact that must be the same, and rests and loads for the periods of the
    manual."""
    output_of(implam, "new", "--rig", "d7137", cwd=folder)
    impact, compression = ((folder / f"{rig}.nml").read_text(encoding="utf-8") for rig in ("d7136", "d7137"))
    for group in ("case", "plate", "material", "laminate", "ply_damage", "delamination"):
        pattern = re.compile(rf"^&{group} .*?/ *(?:!|$)", re.DOTALL | re.MULTILINE)
        found = [pattern.search(deck) for deck in (impact, compression)]
        require(all(found) and found[0][0] == found[1][0], f"&{group} differs.")
    printed = output_of(implam, "check", "d7137.nml", cwd=folder)
    period = float(re.search(r"period of the first bending mode +([\d.]+)", printed)[1])
    rest, end = (1e3*float(re.search(rf"{key}=([\d.e-]+)", compression)[1]) for key in ("settle", "end"))
    print(f"compression of the rig: period {period} ms, at rest after {rest:.2g} ms, loaded for {end - rest:.2g} ms")
    require("no errors" in printed and rest >= 1.3*period and end - rest >= 10*period, printed)
    require(printed.count("warning:") <= 3, printed)


def check_stiffened_rig(implam, folder):
    """The decks of the stiffened panel are those of input/ with comments: the same scales. The panel comes to rest."""
    for rig, deck in (("stiffened", "stiffened_panel"), ("stiffened_compression", "stiffened_panel_compression")):
        output_of(implam, "new", "--rig", rig, cwd=folder)
        printed, given = (output_of(implam, "check", path, cwd=folder)
                          for path in (f"{rig}.nml", str(HERE.parents[1] / "input" / f"{deck}.nml")))
        scales, others = (page.partition("Scales of the case:")[2].partition("About")[0] for page in (printed, given))
        require("no errors" in printed and scales == others, f"{rig} differs from input/{deck}.nml:\n{scales}{others}")
    period = float(re.search(r"period of the first bending mode +([\d.]+)", printed)[1])
    rest = 1e3*float(re.search(r"settle=([\d.e-]+)", (folder / f"{rig}.nml").read_text(encoding="utf-8"))[1])
    print(f"stiffened panel: period {period} ms, at rest after {rest:.2g} ms")
    require(rest >= 1.3*period, "The panel does not come to rest.")


def check_new(implam, folder):
    """The starter deck passes the check without a warning, grows a delamination, and overwrites nothing."""
    output_of(implam, "new", cwd=folder)
    printed = output_of(implam, "check", "impact.nml", cwd=folder)
    require("no errors" in printed and "warning:" not in printed, f"The starter has faults: {printed}")
    before = (folder / "impact.nml").read_bytes()
    require("is not overwritten" in output_of(implam, "new", cwd=folder, code=EXIT_FILES), "An existing file passes.")
    require((folder / "impact.nml").read_bytes() == before, "`implam new` overwrites.")
    output_of(implam, "new", "mine.nml", cwd=folder)
    require((folder / "mine.nml").read_bytes() == before, "With a name the deck differs.")
    require("Wrote d7136.nml" in output_of(implam, "new", "--rig", "d7136", cwd=folder), "No deck of the rig.")
    printed = output_of(implam, "check", "d7136.nml", cwd=folder)
    thickness, energy = (float(re.search(rf"{name} +([\d.e+-]+)", printed)[1])
                         for name in ("thickness of the laminate", "impact energy"))
    require("no errors" in printed and 4 <= thickness <= 6, printed)
    require(abs(energy - 6.7*thickness) < 0.01*energy, "The energy is not that of D7136.")
    require(printed.count("warning:") <= 2, "There are more warnings than one for plies and one for interfaces.")
    require("d7136, d7137, stiffened, " in output_of(implam, "new", "--rig", "d7138", code=EXIT_USAGE),
            "The rigs are not listed.")
    check_compression_of_rig(implam, folder)
    check_stiffened_rig(implam, folder)
    require("new" in output_of(implam, "check", "--rig", "d7136", code=EXIT_USAGE), "--rig is accepted without new.")
    output_of(implam, "new", "no/such/folder.nml", cwd=folder, code=EXIT_FILES)
    run_coarse(implam, folder)
    history = read_history(folder / "results" / "coarse_history.csv")
    area = history["delaminated_area"]
    print(f"new: peak force {max(history['force']):.0f} N, area {area[0]:.3g} to {area[-1]:.3g} m2")
    require(area[0] == 0 and area[-1] > 1e-4 and history["force"][-1] == 0, "No growth, or the impact has not ended.")


def check_full_disk(implam, folder):
    """Files that cannot be completed are reported, and nothing is left of them."""
    folder.mkdir()
    deck = HERE.parents[1] / "input" / "small" / "cohesive.nml"
    for words in (["new", "full.nml"], ["queue", "slurm", str(deck)]):
        # A limit of the size of files fails as a full disk does.
        done = subprocess.run([implam, *words], cwd=folder, stdin=subprocess.DEVNULL, capture_output=True, text=True,
                              timeout=60, check=False,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (100, 100)))
        require(done.returncode == EXIT_FILES and "Cannot write" in done.stderr and not done.stdout, f"{words}: {done}")
    require(not [*folder.iterdir()], f"There are {[*folder.iterdir()]}.")
    print("full disk: done")


def run_coarse(implam, folder):
    """Run the starter deck with cells of twice the size, for an eighth of the processor time; only these are warned
    of."""
    text = (folder / "impact.nml").read_text(encoding="utf-8")
    for fine, coarse in (("elements=26, 20", "elements=14, 12"), ("cell=1e-3", "cell=2e-3"),
                         ("patch=2e-3", "patch=4e-3")):
        require(text.count(fine) == 1, f"The starter has no {fine}.")
        text = text.replace(fine, coarse)
    (folder / "coarse.nml").write_text(text, encoding="utf-8")
    printed = output_of(implam, "coarse.nml", cwd=folder)
    warned = [line for line in printed.splitlines() if "warning" in line]
    require(warned and all("process zone" in line for line in warned), printed)


def main():
    """Check everything in an empty folder."""
    implam, folder = os.path.abspath(sys.argv[1]), Path(sys.argv[2])
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    check_help(implam)
    check_explain(implam)
    check_slips(implam, folder)
    check_options(implam, folder)
    check_interrupt(implam, folder)
    check_cut_step(implam, folder)
    check_pages(implam, folder)
    check_zsh(implam, folder)
    check_new(implam, folder)
    check_full_disk(implam, folder / "full")


if __name__ == "__main__":
    main()
