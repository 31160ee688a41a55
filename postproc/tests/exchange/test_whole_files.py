"""Complete files of bulk data in many formats: each is converted or refused with the card to change."""

import re
from collections.abc import Callable, Iterator

from implam_post.io.deck import read_deck
from tests.exchange.test_from_nastran import ImportTest

HEAD = "SOL 101\nCEND\nTITLE = panel\nSUBCASE 1\n  SPC = 1\n  LOAD = 2\nBEGIN BULK\n"
MATERIAL = "MAT8,1,139000.,9400.,.309,4500.,4600.,2980.,1.58-9\n,0.,0.,,1517.,1590.,46.,253.,105.\n"
LAMINATE = "PCOMP,1,,,,,,,SYM\n,1,.25,45.,YES,1,.25,0.,YES\n,1,.25,-45.,YES,1,.25,90.,YES\n"
SUPPORTS = "SPC1,1,123456,1,2,3,4,5,6\nSPC1,1,123456,10,11,15,16,20,21\nSPC1,1,123456,22,23,24,25\n"
GRIDS = [(1 + i + 5 * j, f"{50 * i}.", f"{25 * j}.") for j in range(5) for i in range(5)]
CORNERS = [(1 + i + 4 * j, 1 + i + 5 * j, 2 + i + 5 * j, 7 + i + 5 * j, 6 + i + 5 * j)
           for j in range(4) for i in range(4)]
SYSTEM = "CORD2R,7,,0.,0.,0.,0.,0.,1.\n,1.,1.,0.\n"


def free_grids(grids: list[tuple[int, str, str]] = GRIDS, system: str = "", more: str = "") -> str:
    """Return grids with commas."""
    return "".join(f"GRID,{number},{system},{x},{y},0.{more}\n" for number, x, y in grids)


def free_elements(kind: str = "CQUAD4", more: str = "", laminate: int = 1) -> str:
    """Return elements with commas."""
    return "".join(f"{kind},{number},{laminate},{a},{b},{c},{d}{more}\n" for number, a, b, c, d in CORNERS)


def whole(material: str = MATERIAL, laminate: str = LAMINATE, grids: str = "", elements: str = "",
          supports: str = SUPPORTS, more: str = "", head: str = HEAD) -> str:
    """Return a file."""
    return head + material + laminate + (grids or free_grids()) + (elements or free_elements()) + supports + more


def columns(line: str, width: int = 8) -> str:
    """Return a line with commas in columns, as small or large fields."""
    first, *others = line.split(",")
    return first.ljust(8) + "".join(field.ljust(width) for field in others)


def in_columns(text: str, change: Callable[[str], str] = columns) -> str:
    """Return bulk data after the case control in columns."""
    head, bulk = text.split("BEGIN BULK\n")
    return f"{head}BEGIN BULK\n" + "\n".join(map(change, bulk.splitlines())) + "\n"


def large(line: str) -> str:
    """Return a line with commas as lines of large fields; continuations keep to eight fields a card."""
    first, *others = line.split(",")
    halves = [others[start:start + 4] for start in range(0, 8, 4)]
    lines = [f"{first + '*' if first else '*':<8}", f"{'*':<8}"]
    return "\n".join(start + "".join(field.ljust(16) for field in half)
                     for start, half in zip(lines, halves, strict=True))


def with_marks(text: str) -> str:
    """Return small fields with named continuations, which follow all other cards in reverse order."""
    head, bulk = text.split("BEGIN BULK\n")
    lines = [columns(line) for line in bulk.splitlines()]
    for number in range(1, len(lines)):
        if lines[number].startswith(" "):
            mark = f"+C{number}"
            lines[number - 1] = f"{lines[number - 1]:<72}{mark}"
            lines[number] = f"{mark:<8}{lines[number][8:]}"
    lines.sort(key=lambda line: line[0] == "+")
    cards = sum(line[0] != "+" for line in lines)
    return f"{head}BEGIN BULK\n" + "\n".join([*lines[:cards], *reversed(lines[cards:])]) + "\n"


# Formats of the same panel.
SAME = {
    "commas": whole(),
    "no end": whole() + "ENDDATA\nrubbish,,\n",
    "no case control": whole(head=""),
    "small fields": in_columns(whole()),
    "large fields": in_columns(whole(), large),
    "tabs": re.sub(",", "\t", whole()),
    "lower case": whole().lower(),
    "returns": whole().replace("\n", "\r\n"),
    "blanks after commas": re.sub(",", ", ", whole()),
    "blanks before names": in_columns(whole(), lambda line: columns(line if line[0] == "," else f"  {line}")),
    "comments": whole().replace("\n", " $ of the test\n$ another, line\n"),
    # The second byte of Å in UTF-8 is a line end for str.splitlines.
    "letters of a comment": whole(laminate=LAMINATE + "$ of the test in Å,1,.25,0.,YES\n"),
    "equation with commas": whole(more="DEQATN  1       F(A,B,C,D,E,G,H)=SUM(A,B,C,D,E,G,H)\n"),
    "begin with a comma": whole(head=HEAD.replace("BEGIN BULK", "BEGIN, BULK")),
    "ranges": whole(supports="SPC1,1,123456,1,THRU,5\nSPC1,1,123456,21,THRU,25\nSPC1,1,123456,6,11,16,10,15,20\n"),
    "sets in two cards": whole(head=HEAD.replace("SPC = 1", "SPC = 9"), more="SPCADD,9,1\nSPCADD,9,2\n",
                               supports=SUPPORTS.replace("SPC1,1,123456,22", "SPC1,2,123456,22")),
    "pairs": whole(supports="".join(f"SPC,1,{number},123456,0.\n" for number in (
        *range(1, 7), 10, 11, 15, 16, *range(20, 26)))),
    "system of the grids": whole(grids=SYSTEM.replace(",1.,1.,0.", ",1.,0.,0.") + free_grids(system="7")),
    "default of the grids": whole(grids="GRDSET,,,,,,,6\n" + free_grids(),
                                  supports=SUPPORTS.replace("123456", "12345")),
    "turned displacements": whole(grids=SYSTEM + free_grids(more=",7")),
    "two equal laminates": whole(laminate=LAMINATE + LAMINATE.replace("PCOMP,1", "PCOMP,2"), elements=re.sub(
        r"^(CQUAD4,\d),1", r"\1,2", free_elements(), flags=re.MULTILINE)),
    "other cards": whole(more="PARAM,POST,-1\nPLOAD4,2,1,.01,,,,THRU,16\nFORCE,2,13,,100.,0.,0.,1.\nEIGRL,1,,,10\n"),
}
# Files that are refused, with parts of the message.
REFUSED = {
    "MAT2": (whole(material="MAT2,1,139000.,3000.,0.,9400.,0.,4500.,1.6-9\n"), "8: MAT2", "as a MAT8"),
    "MAT9": (whole(material="MAT9,1,139000.,3000.,3000.\n"), "8: MAT9", "as a MAT8"),
    "no material": (whole(material=""), "8: PCOMP", "there is no MAT1 or MAT8 with number 1"),
    "membrane": (whole(material="MAT1,1,7.+4,,.3\n", laminate="PSHELL,1,1,2.\n"), "9: PSHELL", "give MID2 = MID1"),
    "sphere": (whole(grids="CORD2S" + SYSTEM[6:] + free_grids(system="7")), "13: CORD2S", "must be a CORD2R"),
    "system of grids": (whole(grids="CORD1R,7,1,2,6\n" + free_grids(), elements=free_elements(more=",7")),
                        "13: CORD1R", "must be a CORD2R"),
    "system of itself": (whole(grids="CORD2R,8,7" + SYSTEM[9:] + "CORD2R,7,8" + SYSTEM[9:] + free_grids(system="8")),
                         "13: CORD2R", "refers to itself through system 7"),
    "system on a line": (whole(grids=SYSTEM.replace(",1.,1.,0.", ",0.,0.,5.") + free_grids(system="7")),
                         "13: CORD2R", "are collinear"),
    "system on a line of another": (whole(grids="CORD2R,8,7" + SYSTEM[9:].replace(",1.,1.,0.", ",0.,0.,5.") + SYSTEM
                                          + free_grids(system="8")), "13: CORD2R", "are collinear"),
    "turned": (whole(grids=SYSTEM + free_grids(system="7")), "CQUAD4", "45 degrees", "in the axes of the edges"),
    "hole": (whole(elements=re.sub(r"CQUAD4,6,.*\n", "", free_elements())), "CQUAD4", "no holes"),
    "both sides": (whole(elements=re.sub(r"(CQUAD4,9,1),(\d+),(\d+),(\d+),(\d+)", r"\1,\2,\5,\4,\3", free_elements())),
                   "46: CQUAD4", "in the opposite sense", "number all in the same sense"),
    "twice": (whole(more="CQUAD4,1,1,1,2,7,6\n"), "57: CQUAD4", "number 1 is used", "line 38"),
    "symmetry": (whole(supports="SPC1,1,123456,5,10,15,20\nSPC1,1,123456,21,22,23,24,25\nSPC1,1,15,1,6,11,16\n"
                                "SPC1,1,24,1,2,3,4\n"), "SPC1", "line of symmetry", "both sides"),
    "corner": (whole(supports="SPC1,1,3,6,11,16,21\nSPC1,1,3,22,23,24,25\n"), "SPC1", "corner grid 1"),
    "turned support": (whole(grids=SYSTEM + free_grids(more=",7"), supports=SUPPORTS.replace("123456", "13")),
                       ": GRID", "leave CD blank"),
    "other set": (whole(head=HEAD.replace("SPC = 1", "SPC = 10")), "SPC = 10", "SPC1 or SPC of set 10"),
    "number": (whole(material=MATERIAL.replace("139000.", "139000")), "8: MAT8", "E11", "with a decimal point"),
    "steps of a range": (whole(supports="SPC1,1,123456,6,THRU,16,BY,5\n"), "54: SPC1", "'BY' is not an integer"),
    "plies that do not continue": (whole(laminate="PCOMP,1\n1,1,.25,45.,YES\n"), "11: 1", "a continuation has blanks"),
    "no first material": (whole(laminate="PCOMP,1\n,,.25,45.\n"), "10: PCOMP", "MID1 is blank"),
    "no first thickness": (whole(laminate="PCOMPG,1\n,1,1,,45.\n"), "10: PCOMPG", "T1 is blank"),
    "no plies": (whole(laminate="PCOMP,1\n"), "10: PCOMP", "it has no plies"),
    "lost continuation": (in_columns(whole()).replace("PCOMP   1" + " " * 55 + "SYM     ", "PCOMP   1" + " " * 55
                          + "SYM     +A").replace("        1       .25     45.", "+B      1       .25     45."),
                          "11: +B", "no card has this continuation mark"),
    "long number": (whole(more="GRID,99,,-5.5511151231258-17,0.,0.\n"), "57: GRID", "has more than 16 characters"),
    "two temperatures": (whole(more="TEMPD,4,20.\nTEMPD,4,30.\n", material=MATERIAL.replace("0.,0.", "0.,3.-5")),
                         "58: TEMPD", "set 4 has another temperature in line 57"),
    "no BEGIN BULK": (whole(head=HEAD.replace("BEGIN BULK\n", "")), "2: CEND", "no line BEGIN BULK"),
    "superelement": (whole(more="BEGIN SUPER=1\nPARAM,WTMASS,.00259\n"), "57: BEGIN SUPER=1", "of its own file"),
    "bulk of a superelement": (whole(head=HEAD.replace("BULK", "BULK SUPER = 3")), "7: BEGIN BULK SUPER = 3", "own"),
    "auxiliary model": (whole(more="  begin auxmodel=2\nGRID,1,,7.,7.,7.\n"), "57: BEGIN AUXMODEL=2", "own file"),
    "module without BEGIN BULK": (whole(head="", more="BEGIN,MODULE=4\n"), "50: BEGIN,MODULE=4", "own file"),
    "two parts": (whole(more="BEGIN BULK\n"), "57: BEGIN BULK", "another one above"),
    "same element twice": (whole(more="CQUAD4,99,1,1,2,7,6\n"), "57: CQUAD4", "overlaps the CQUAD4 in line 38"),
    "second layer": (whole(more="".join(f"GRID,{40 + place},,{x}.,{y}.\n" for place, (x, y) in enumerate(
        [(0, 0), (50, 0), (50, 25), (0, 25)])) + "CQUAD4,99,1,40,41,42,43\n"), "61: CQUAD4", "overlaps", "line 38"),
    "part of an element": (whole(more="".join(f"GRID,{40 + place},,{x}.,{y}.\n" for place, (x, y) in enumerate(
        [(10, 5), (70, 5), (70, 20), (10, 20)])) + "CQUAD4,99,1,40,41,42,43\n"), "61: CQUAD4", "overlaps", "line 38"),
    "overlap as large as a hole": (whole(elements=free_elements().replace(
        "CQUAD4,6,1,7,8,13,12", "CQUAD4,6,1,1,2,7,6")), "43: CQUAD4", "overlaps the CQUAD4 in line 38"),
    "no quadrilaterals": (whole(elements=free_elements("CQUADR")), "CQUADR, lines 38-53", "CQUAD4 or CQUAD8 only"),
    "CQDMEM": (whole(elements=free_elements().replace("CQUAD4,7,", "CQDMEM,7,")), "CQDMEM, line 44", "only"),
    "CQUAD1": (whole(elements=free_elements().replace("CQUAD4,16,", "CQUAD1,16,")), "CQUAD1, line 53", "only"),
    "blanks in a number": (whole(material=MATERIAL.replace("4600.", ".50  E+6")), "8: MAT8", "field 6, '.50  E+6',"),
    "two numbers in a field": (in_columns(whole()).replace("2980.   ", "29. 80. "), "8: MAT8", "field 7, '29. 80.',"),
    "blank in a temperature": (whole(more="TEMPD,4,2 0.\n", material=MATERIAL.replace("0.,0.", "0.,3.-5")),
                               "57: TEMPD", "field 2, '2 0.', has"),
    "blank in WTMASS": (whole(head=HEAD.replace("BEGIN", "PARAM,WTMASS,.50  E+6\nBEGIN")), ":7: PARAM",
                        "WTMASS,.50  E+6 in the case control"),
    "include": (whole(more="INCLUDE 'more.bdf'\n"), "57: INCLUDE", "into one file"),
    "include above": (whole(head="INCLUDE 'case.txt'\n" + HEAD), "INCLUDE", "into one file"),
    "triangles": (whole(elements=free_elements().replace("CQUAD4,1,1,1,2,7,6", "CTRIA3,1,1,1,2,7\nCTRIA3,99,1,1,7,6")),
                  "CTRIA3, lines 38-39", "CQUAD4 or CQUAD8 only"),
    "two laminates": (whole(laminate=LAMINATE + LAMINATE.replace("PCOMP,1", "PCOMP,2").replace("45.", "30."),
                            elements=re.sub(r"^(CQUAD4,\d),1", r"\1,2", free_elements(), flags=re.MULTILINE)),
                      "10: PCOMP", "its lay-up differs"),
}


class WholeFilesTest(ImportTest):
    """Each file."""

    def groups(self, text: str) -> Iterator[str]:
        """Return the groups of the deck of a file."""
        code, printed = self.run_command(text)
        self.assertEqual(code, 0, printed)
        return (line for line in (self.folder / "panel.nml").read_text().splitlines() if line[0] != "!")

    def test_same_panel(self) -> None:
        """The deck does not depend on the format of the file."""
        expected = list(self.groups(SAME["commas"]))
        self.assertEqual(read_deck(self.folder / "panel.nml").edges(), 4 * ["clamped"])
        for name, text in {**SAME, "named continuations": with_marks(whole())}.items():
            with self.subTest(name):
                self.assertEqual(list(self.groups(text)), expected)

    def test_no_text(self) -> None:
        """Binary files, such as results, are refused."""
        code, printed = self.run_command("\0\1" + whole())
        self.assertEqual((code, printed.count("\n")), (4, 1), printed)
        self.assertIn("is not a text file", printed)

    def test_refused(self) -> None:
        """The message has the card and what to change."""
        for name, (text, *words) in REFUSED.items():
            with self.subTest(name):
                code, printed = self.run_command(text)
                self.assertEqual((code, printed.count("\n")), (2, 1), printed)
                for word in words:
                    self.assertIn(word, printed)
