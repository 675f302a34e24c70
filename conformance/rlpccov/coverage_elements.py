"""Goals among the values of a syntax element, from its descriptor and the requirements on it."""

import ast

import spec_program
from coverage_sites import Element, Loop, Value

EVERY_VALUE = 8  # in a range of at most this many values, each value is a goal
_SIGNS = ("negative", "zero", "positive")
_BITS = ("all-zeros", "all-ones")


def instrument(instrumenter, statement, following):
    """Instruments the statement to record the value, if it reads a syntax element."""
    call = statement.value
    if not (isinstance(call, ast.Call) and isinstance(call.func, ast.Name)
            and spec_program.is_descriptor(call.func.id)
            and instrumenter.where.clause.split(".")[0] != spec_program._PARSING_PROCESS):
        return
    target = ast.unparse(statement.targets[0])
    limits = limits_of(instrumenter.target, target, following)
    outcomes = goals(instrumenter, call, limits)
    site = instrumenter.add(Element, [spec_program._base_name(statement.targets[0])], statement,
                            ast.unparse(statement), outcomes, _BITS[0] in outcomes)
    if site.bits:
        last = call.args[-1]
        call.args[-1] = ast.Call(ast.Name(site.name("N"), ast.Load()), [last], [])
    statement.value = ast.Call(ast.Name(site.name("E"), ast.Load()), [call], [])


def goals(instrumenter, call, limits):
    """The outcomes of an element read by this call, within limits (least, greatest)."""
    descriptor, target = call.func.id, instrumenter.target
    least, greatest = limits
    if descriptor == "u":
        bits = target.constant(call.args[0])
        if bits is not None:
            least = 0 if least is None else least
            greatest = (1 << bits) - 1 if greatest is None else greatest
    elif descriptor == "ue":
        least = 0 if least is None else least
    elif descriptor == "ae":
        least, greatest = 0, 1
    elif descriptor == "ae_unary":
        least, greatest = 0, target.models.size(call.args[0])
    elif descriptor == "ae_tree":
        return _BITS
    elif descriptor == "bypass":
        return ("no-bits",) + _BITS
    signs = _SIGNS if descriptor in ("se", "ae_residual", "ae_header") else ()
    if None not in (least, greatest) and greatest - least < EVERY_VALUE:
        return signs + tuple(str(n) for n in range(least, greatest + 1))
    return signs + tuple(str(n) for n in (least, greatest) if n is not None)


def limits_of(target, name, following):
    """(least, greatest) that the requirements after an element impose; None: not a constant."""
    least = greatest = None
    for statement in following:
        if isinstance(statement, ast.Assign) and ast.unparse(statement.targets[0]) != name:
            continue  # requires something of another element, or of ElementPosition
        call = statement.value if isinstance(statement, ast.Expr) else None
        if not (isinstance(call, ast.Call) and isinstance(call.func, ast.Name)):
            break
        if call.func.id not in ("require", "supported"):
            continue
        test = call.args[0]
        parts = test.values if isinstance(test, ast.BoolOp) and isinstance(test.op, ast.And) \
            else [test]
        for part in parts:
            if not isinstance(part, ast.Compare) or ast.unparse(part.left) != name:
                continue
            bound, operator = target.constant(part.comparators[0]), type(part.ops[0])
            if bound is None:
                continue
            if operator in (ast.Lt, ast.LtE, ast.Eq):
                greatest = bound - (operator is ast.Lt)
            if operator in (ast.Gt, ast.GtE, ast.Eq):
                least = bound + (operator is ast.Gt)
    return least, greatest


def counts_of_loop(test):
    """Numbers of iterations of  while name < N ..., a loop that counts up to N at most."""
    parts = test.values if isinstance(test, ast.BoolOp) and isinstance(test.op, ast.And) \
        else [test]
    for part in parts:
        if (isinstance(part, ast.Compare) and isinstance(part.ops[0], ast.Lt)
                and isinstance(part.left, ast.Name)
                and isinstance(part.comparators[0], ast.Constant)
                and part.comparators[0].value < 64):
            return range(part.comparators[0].value + 1)
    return ()


def apply_settings(target):
    """Goals that coverage_goals.json adds; each of its entries must match a site."""
    for name, entry in target.settings.get("elements", {}).items():
        sites = [s for s in target.sites if isinstance(s, Element) and s.element == name]
        for site in _found(sites, name):
            site.outcomes += [str(v) for v in entry["values"] if str(v) not in site.outcomes]
    for name, entry in target.settings.get("loops", {}).items():
        for site in _found(_sites(target, name, Loop), name):
            site.count(range(entry["counts"][0], entry["counts"][1] + 1))
    for name, entry in target.settings.get("values", {}).items():
        for site in _found(_sites(target, name, Value), name):
            site.want(entry.get("least"), entry.get("greatest"))


def _sites(target, name, kind):
    return [s for f in target.functions for s in f.sites
            if isinstance(s, kind) and f"{f.key}/{s.text}" == name]


def _found(sites, name):
    if not sites:
        raise spec_program.SpecError(f"coverage_goals.json: {name} matches nothing; has the "
                                     "specification changed?")
    return sites
