"""Checkpoints that a restart accepts, and those that it refuses.
Usage: checkpoint_files.py TRIAL IMPLAM FOLDER [LAUNCHER...]     (LAUNCHER takes the number of ranks as its last word)

found        without a file the newest complete checkpoint of a folder is read, and results keep the name of the case
mixed        results of another run are neither continued nor combined with the checkpoint of another
damaged      a file that is no checkpoint, or incomplete, ends with the exit code of files and a sentence
full         a failed write of fields or checkpoint ends the run with that code and the reason, without a checkpoint
size_limit   so does the limit of the size of files, on one rank and on two"""

import errno
import os
import random
import subprocess
import sys
from pathlib import Path

from restart import DAMAGE, IMPACT, SHORT, SINGLE_STEP, copy_run, go_on, main, split_at
from solver_runs import (
    EXIT_FILES,
    EXIT_STOPPED,
    LONGEST_RUN,
    checkpoint_of,
    history_of,
    require,
    run,
    run_deck,
    write_deck,
)

# Text of the message for each error of a write.
REASONS = {errno.ENOSPC: "no space is left on the disk", errno.EDQUOT: "the quota of this user on the disk is used up",
           errno.EFBIG: "the limit of the size of files (ulimit -f) is reached"}


def check_damaged(implam, folder, _):
    """Files that are not checkpoints, or incomplete ones."""
    deck = write_deck(folder / "sound", IMPACT, split_at(0.53, SHORT))
    run_deck(implam, deck)
    sound = checkpoint_of(deck.parent).read_bytes()
    moments = random.Random(2)
    damaged = {"empty": b"", "text": b"&case /\n", "noise": moments.randbytes(len(sound)),
               "fields": history_of(deck.parent).with_name("sun_chen_tan_sun.h5").read_bytes(),
               "longer": sound + b"\0" * 512}
    for share in (0.001, 0.1, 0.5, 0.9, 0.999):
        damaged[f"cut at {share}"] = sound[:int(share * len(sound))]
    for _ in range(10):
        place = moments.randrange(len(sound))
        damaged[f"byte {place}"] = sound[:place] + bytes([sound[place] ^ 0x41]) + sound[place + 1:]
    for name, content in damaged.items():
        path = folder / "damaged_restart.h5"
        path.write_bytes(content)
        said = run([implam, "restart", path], EXIT_FILES)
        lines = [line for line in said.splitlines() if line.strip()]
        require(len(lines) == 1 and lines[0].startswith("implam: ") and lines[0].endswith("."),
                f"{name}: instead of one sentence\n{said}")
        require(path.read_bytes() == content, f"{name}: the file was changed.")
        print(f"{name}: {lines[0]}")
    said = run([implam, "restart", folder / "nowhere.h5"], EXIT_FILES)
    print(f"absent: {said.strip()}")


def one_sentence_of(said, what):
    """Return the printed text, which must be one sentence."""
    lines = [line for line in said.splitlines() if line.startswith("implam: ")]
    require(len(lines) == 1 and lines[0].endswith("."), f"{what}: instead of one sentence\n{said}")
    return lines[0]


def refuse(implam, checkpoint, what):
    """Restart where it must be refused; no result may be changed."""
    def results():
        return {path.name: path.read_bytes() for path in checkpoint.parent.iterdir() if path.suffix != ".log"}

    before = results()
    print(f"{what}: {one_sentence_of(run([implam, 'restart', checkpoint], EXIT_FILES), what)}")
    require(results() == before, f"{what}: results were changed.")


def check_found(implam, folder, _):
    """A case named by the file of its deck, and a checkpoint of another one in the folder that is older, newer or
    damaged."""
    deck = write_deck(folder / "whole", DAMAGE, ["time%end=60e-6"])
    text = deck.read_text(encoding="utf-8")
    unnamed = text.replace("name='damage'", "")
    require(unnamed != text, "The deck has a name still.")
    references = {}
    for name, content in (("rs", unnamed), ("damage", text)):
        deck = deck.with_name(f"{name}.nml")
        deck.write_text(content, encoding="utf-8")
        run([implam, deck, "--output", folder / "whole"])
        references[name] = (folder / "whole" / f"{name}_history.csv").read_bytes()
        run([implam, deck, "--output", folder / "stopped", *SINGLE_STEP], EXIT_STOPPED)
    os.utime(folder / "stopped" / "rs_restart.h5", (0, 0))
    content = (folder / "stopped" / "damage_restart.h5").read_bytes()
    for name, way in (("damage", ["restart"]), ("rs", ["restart"]), ("rs", ["restart", "."]),
                      ("rs", ["restart", "--output", folder.resolve() / "here"])):
        here = copy_run(folder / "stopped", folder / "here")
        if name == "rs":
            (here / "damage_restart.h5").write_bytes(content[:-1])
        said = run([implam, *way], folder=here)
        require(f"{name}_restart.h5" in said, f"The checkpoint read is not printed:\n{said}")
        require((here / f"{name}_history.csv").read_bytes() == references[name], f"{name}: the history differs.")
        histories = sorted(path.name for path in here.glob("*_history.csv"))
        require(histories == ["damage_history.csv", "rs_history.csv"], f"There are {histories}.")
        print(f"{name} by {way}: the same to the last bit")
    for path in here.glob("*_restart.h5"):
        path.write_bytes(content[:-1])
    print(one_sentence_of(run([implam, "restart"], EXIT_FILES, here), "no checkpoint"))


def check_mixed(implam, folder, _):
    """A run with checkpoints, a run of another deck without checkpoints in its folder, then a restart."""
    deck = write_deck(folder / "both", DAMAGE, ["output%checkpoint_every=50e-6", "output%fields_every=50e-6"])
    run_deck(implam, deck)
    alone = copy_run(deck.parent, folder / "alone")
    checkpoint = checkpoint_of(deck.parent)
    content = checkpoint.read_bytes()
    other = write_deck(folder / "other", DAMAGE, ["impactor%velocity=4", "output%checkpoint_at_end=.false."])
    said = run([implam, other, "--output", deck.parent])
    old = checkpoint.with_name(checkpoint.name + ".old")
    require(not checkpoint.exists() and old.read_bytes() == content and old.name in said,
            f"The older checkpoint has not been moved, or its place is not printed:\n{said}")
    refuse(implam, old, "history")
    history_of(deck.parent).rename(folder / "history.csv")
    refuse(implam, old, "fields")
    (deck.parent / "damage.h5").unlink()
    (folder / "history.csv").rename(deck.parent / "damage_history.csv")
    refuse(implam, old, "history alone")
    reference = history_of(alone).read_bytes()
    require(go_on(implam, alone).read_bytes() == reference, "Without other results the continued history differs.")


def check_full(implam, folder, _):
    """One write fails, anywhere in fields and checkpoint; afterwards writes succeed again."""
    library, count = folder.resolve() / "full.so", folder.resolve() / "count"
    deck = write_deck(folder, DAMAGE)
    source = Path(__file__).resolve().parents[1] / "support/full_disk.c"
    run(["cc", "-shared", "-fPIC", "-o", library, source, "-ldl"])

    def run_with(number, code, error=errno.ENOSPC):
        here = folder / str(number)
        said = run(["env", f"LD_PRELOAD={library}", f"FULL_AT={number}", f"FULL_ERROR={error}",
                    f"FULL_COUNT={count}", implam, deck, "--output", here, *SINGLE_STEP], code)
        return said, list(here.glob("*_restart.h5"))

    run_with(0, EXIT_STOPPED)
    writes = int(count.read_text(encoding="utf-8"))
    require(writes > 100, f"There were only {writes} writes.")
    for place, number in enumerate(random.Random(3).sample(range(1, writes + 1), 12)):
        error, reason = list(REASONS.items())[place % len(REASONS)]
        said, checkpoints = run_with(number, EXIT_FILES, error)
        require(not checkpoints, f"Write {number} of {writes} failed, and a checkpoint is left.")
        sentence = one_sentence_of(said, number)
        print(f"write {number} of {writes}: {sentence}")
        require(reason in sentence, "The reason is missing.")


def check_limit(implam, folder, launcher):
    """The limit of the size of files, which by default ends a program by a signal, met at the start and while fields
    are written. On two ranks HDF5 would wait forever. Open MPI 5 does not start under the limit, as its shared
    memory is a larger file."""
    settings = ["mesh%elements=24, 24", "output%fields_every=10e-6"]
    deck = write_deck(folder, DAMAGE, settings)
    for ranks in (1, 2):
        for kilobytes in (16, 1400):
            limited = ["bash", "-c", f'ulimit -f {kilobytes}; exec "$@"', "bash", implam, deck, "--output",
                       folder / f"out_{ranks}"]
            command = [*launcher, ranks, *limited] if ranks > 1 else limited
            ended = subprocess.run([str(word) for word in command], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT, text=True, timeout=LONGEST_RUN, check=False)  # fmt: skip
            if ranks > 1 and "failed during shared memory initialization" in ended.stdout:
                print(f"{ranks} ranks, {kilobytes} KiB: MPI does not start")
                continue
            require(ended.returncode == EXIT_FILES, f"{ranks} ranks: code {ended.returncode}\n{ended.stdout}")
            sentence = one_sentence_of(ended.stdout, kilobytes)
            require(REASONS[errno.EFBIG] in sentence, sentence)


TRIALS = {"found": check_found, "mixed": check_mixed, "damaged": check_damaged, "full": check_full,
          "size_limit": check_limit}


if __name__ == "__main__":
    raise SystemExit(main(TRIALS, *sys.argv[1:]))
