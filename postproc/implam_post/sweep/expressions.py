"""Formulas of names and numbers, such as sqrt(2*energy/impactor.mass); other expressions are refused."""

import ast
import math
import operator
from collections.abc import Callable

from implam_post.io.errors import DeckError

Number = int | float
Lookup = Callable[[str], object]

_OPERATORS: dict[type, Callable[..., Number]] = {
    ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv,
    ast.Pow: lambda base, exponent: math.pow(base, exponent), ast.USub: operator.neg, ast.UAdd: operator.pos}
CONSTANTS = {"pi": math.pi}
FUNCTIONS: dict[str, Callable[..., Number]] = {
    "sqrt": math.sqrt, "exp": math.exp, "log": math.log, "log10": math.log10, "sin": math.sin, "cos": math.cos,
    "tan": math.tan, "atan": math.atan, "radians": math.radians, "degrees": math.degrees, "abs": abs, "min": min,
    "max": max, "round": lambda value: round(value), "int": lambda value: int(value)}
LONGEST = 1000


def evaluate(formula: str, lookup: Lookup) -> Number | list[Number]:
    """Return the value of a formula, a number or a list of numbers.

    `lookup` returns the value of a name, of group.key or of group[2].key; it raises DeckError for unknown ones.
    """
    try:
        if len(formula) > LONGEST:
            raise DeckError(f"it is longer than {LONGEST} letters.")
        tree = ast.parse(formula.strip(), mode="eval").body
        if isinstance(tree, (ast.List, ast.Tuple)):
            return [_value(item, lookup) for item in tree.elts]
        return _value(tree, lookup)
    except DeckError as error:
        raise DeckError(f"the formula {formula!r}: {error}") from None
    except (SyntaxError, ValueError, ArithmeticError, TypeError, RecursionError, MemoryError) as error:
        raise DeckError(f"the formula {formula!r} cannot be evaluated ({error}).") from None


def _value(node: ast.expr, lookup: Lookup) -> Number:
    """Return the value of a part of a formula."""
    if isinstance(node, ast.BinOp) and type(node.op) in _OPERATORS:
        return _finite(_OPERATORS[type(node.op)](_value(node.left, lookup), _value(node.right, lookup)))
    if isinstance(node, ast.UnaryOp) and type(node.op) in _OPERATORS:
        return _OPERATORS[type(node.op)](_value(node.operand, lookup))
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and not node.keywords:
        if node.func.id not in FUNCTIONS:
            raise DeckError(f"'{node.func.id}' is not one of the functions {', '.join(FUNCTIONS)}.")
        return _finite(FUNCTIONS[node.func.id](*(_value(argument, lookup) for argument in node.args)))
    if isinstance(node, ast.Constant):
        return _number(node.value, ast.unparse(node))
    if isinstance(node, ast.Name):
        return CONSTANTS[node.id] if node.id in CONSTANTS else _number(lookup(node.id), node.id)
    path = _path(node)
    if path is None:
        raise DeckError(f"'{ast.unparse(node)}' is not allowed in a formula.")
    return _number(lookup(path), path)


def _path(node: ast.expr) -> str | None:
    """Return a part of a formula as text if it is group.key or group[2].key; otherwise None."""
    if not isinstance(node, ast.Attribute):
        return None
    owner = node.value
    numbered = isinstance(owner, ast.Subscript) and isinstance(owner.slice, ast.Constant)
    return ast.unparse(node) if isinstance(owner.value if numbered else owner, ast.Name) else None


def _number(value: object, what: str) -> Number:
    """Return `value` if it is a finite number."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise DeckError(f"'{what}' is not a number.")
    return _finite(value)


def _finite(value: Number) -> Number:
    """Return `value` if it is finite and real."""
    if isinstance(value, complex) or not math.isfinite(value):
        raise DeckError("an intermediate value is not finite.")
    return value
