"""The specification's program with its coverage counted (sites and goals: coverage_sites.py).

Instrumentation is part of expressions, so that it costs little: a condition c becomes
( ( T := 1 ) if c else ( F := 0 ) ) with global names T and F, and an expression e becomes
( wide if C <= ( wide := e ) <= D else W( wide ) ), which calls W only for a new extreme.
"""

import ast
import copy
import json
import pathlib

import coverage_elements
import coverage_models
import coverage_signs
import spec_program
from coverage_sites import Condition, Loop, Shift, Value

DECODING = "stream"  # decoding a stream is running this function (clause 6)
INTEGER_FUNCTIONS = "5"  # the clause whose functions are counted at each call apart
RULES = ("require", "supported")
_ROUNDING = {ast.RShift: ">>", ast.FloorDiv: "//", ast.Mod: "%"}
# operator -> (smallest difference of the sides that is an edge, when the condition is true)
_EDGES = {ast.Lt: (-1, "gap < 0"), ast.LtE: (0, "gap <= 0"), ast.Gt: (0, "gap > 0"),
          ast.GtE: (-1, "gap >= 0")}


def expression(text, **parts):
    """An expression; names of parts stand for syntax trees."""
    class Fill(ast.NodeTransformer):
        def visit_Name(self, node):
            return parts.get(node.id, node)
    return Fill().visit(ast.parse(text, mode="eval").body)


class Function:
    """Sites of one function, or of a function of clause 5 at one of its calls."""

    def __init__(self, clause, path, origin):
        self.clause = clause
        self.path = path
        self.origin = origin  # the name of the function in the specification
        self.key = f"{clause}/{path}"
        self.sites = []
        self._texts = {}

    def unique(self, kind, text):
        number = self._texts[kind, text] = self._texts.get((kind, text), 0) + 1
        return text if number == 1 else f"{text}#{number}"


class Instrumented:
    """A specification, translated with coverage. Runs as often as wanted: see compile( )."""

    def __init__(self, folder, settings):
        """settings: the contents of coverage_goals.json."""
        self.folder = pathlib.Path(folder)
        self.settings = settings
        self.program = spec_program.Program(folder)
        self.functions = []
        self.sites = []
        nothing = dict.fromkeys(("StreamBytes", *spec_program._GIVEN_FUNCTIONS))
        self.constants = self.program.compile(nothing)
        stored = {n for f, _ in self.program.functions.values()
                  for n in spec_program._stored_names(f)}
        self._constant_names = {n for c in self.program.constants
                                for n in spec_program._stored_names(c)} - stored
        self.models = coverage_models.Models(self)
        self.signs = coverage_signs.Signs(self.program)
        self.for_each = {name: entry["list"]
                         for name, entry in settings.get("for_each", {}).items()}
        self.entries, self.reachable = self._reachable()
        self._code = self.program.code(transform=self._transform)
        coverage_elements.apply_settings(self)

    def _calls(self, node):
        return [p.func.id for p in ast.walk(node) if isinstance(p, ast.Call)
                and isinstance(p.func, ast.Name) and p.func.id in self.program.functions]

    def _reachable(self):
        """(functions to run, all that they call), without those that only constants need.

        Functions to run are stream( ), and after it those without parameters that nothing calls.
        Those of for_each run last, with each element of a list.
        """
        functions = self.program.functions
        called = {n for f, _ in functions.values() for n in self._calls(f)}
        called |= {n for c in self.program.constants for n in self._calls(c)}
        entries = [DECODING] + [n for n, (f, _) in functions.items()
                                if n not in called | {DECODING} and not f.args.args]
        reachable, waiting = set(), entries + list(self.for_each)
        while waiting:
            name = waiting.pop()
            if name not in reachable:
                reachable.add(name)
                waiting += self._calls(functions[name][0])
        return entries, reachable

    def is_integer_function(self, name):
        function = self.program.functions.get(name)
        return function is not None and function[1].split(".")[0] == INTEGER_FUNCTIONS

    def _transform(self, functions):
        self.result = {name: (copy.deepcopy(node), clause)
                       for name, (node, clause) in functions.items()}
        for name, (node, clause) in functions.items():
            if name in self.reachable and not self.is_integer_function(name):
                function = Function(clause, name, name)
                self.functions.append(function)
                file = self.program._places[node].split(":")[0]
                self.result[name] = (_Instrumenter(self, function, file).function(node), clause)
        for node, _ in self.result.values():
            ast.fix_missing_locations(node)
        return self.result

    def rules(self):
        """(rule id, clause, effect) of all rules, sorted."""
        listing = self.folder / "rules.json"
        if not listing.exists():
            return self.rules_checked()
        return sorted((r["rule"], r["clause"], r["effect"])
                      for r in json.loads(listing.read_text(encoding="utf-8")))

    def rules_checked(self):
        """The rules that the program checks."""
        effects = {"require": "invalid", "supported": "unsupported"}
        return sorted({(p.args[1].value, clause, effects[p.func.id])
                       for node, clause in self.program.functions.values()
                       for p in ast.walk(node) if isinstance(p, ast.Call)
                       and isinstance(p.func, ast.Name) and p.func.id in RULES})

    def clone(self, caller, name, call):
        """The name of a copy of a function of clause 5 for this call only."""
        node, _ = self.program.functions[name]
        function = Function(caller.clause, caller.path + " > "
                            + caller.unique("call", ast.unparse(call)), name)
        self.functions.append(function)
        file = self.program._places[node].split(":")[0]
        fixed = {p.arg: a for p, a in zip(node.args.args, call.args)
                 if isinstance(a, ast.Constant)}
        new = _Instrumenter(self, function, file, fixed).function(node)
        new.name = f"{name}At{len(self.functions)}"
        self.result[new.name] = (new, caller.clause)
        return new.name

    def constant(self, node):
        """The value of an expression of constants only, or None."""
        for part in ast.walk(node):
            if isinstance(part, ast.Call):
                if not (isinstance(part.func, ast.Name) and part.func.id in ("len", "range")):
                    return None
            elif isinstance(part, ast.Name) and part.id not in self._constant_names | {
                    "len", "range"}:
                return None
        return eval(ast.unparse(node), self.constants)  # noqa: S307

    def add(self, function, kind, *arguments):
        site = kind(len(self.sites), *arguments)
        self.sites.append(site)
        function.sites.append(site)
        return site

    def compile(self, given, trace=False, widths=False):
        """Like spec_program.Program.compile( ), with nothing seen yet."""
        assert not trace and not widths
        fresh = dict(given)
        for part in self.sites + [self.models]:
            fresh.update(part.given({}))
        namespace = spec_program.run(self._code, fresh)
        for part in self.sites + [self.models]:  # what constants have shown does not count
            namespace.update(part.given(namespace))
        return namespace


class _Instrumenter(ast.NodeTransformer):
    """Instruments one function."""

    def __init__(self, target, function, file, fixed=None):
        self.target = target
        self.where = function
        self.file = file
        self.fixed = fixed or {}  # parameters that are constants at this call
        self.detailed = " > " in function.path  # a call of clause 5

    def function(self, node):
        node = copy.deepcopy(node)
        taken = set(spec_program._stored_names(node)) | {a.arg for a in node.args.args}
        if {n for n in taken if n in ("wide", "gap") or n.startswith(("turns", "Cover"))}:
            raise spec_program.SpecError(f"{node.name}: a variable has a name that rlpccov uses")
        self.fixed = {n: c for n, c in self.fixed.items()
                      if n not in spec_program._stored_names(node)}
        if self.fixed:
            for part in node.body:
                self._fix(part)
        node.body = self.block(node.body)
        if node.name == "ae":
            node.body = coverage_models.record_bins(node)
        return node

    def _fix(self, statement):
        fixed = self.fixed

        class Fix(ast.NodeTransformer):
            def visit_Name(self, node):
                return ast.copy_location(fixed[node.id], node) if node.id in fixed else node
        Fix().visit(statement)

    def place(self, node):
        return f"{self.file}:{node.lineno}"

    def add(self, kind, name, node, text, *more):
        return self.target.add(self.where, kind, *name, self.where.unique(*(name or [kind]), text),
                               self.place(node), *more)

    def block(self, statements):
        result = []
        for i, statement in enumerate(statements):
            if isinstance(statement, ast.Assign):
                coverage_elements.instrument(self, statement, statements[i + 1:])
                coverage_models.instrument(self, statement)
            new = self.visit(statement)
            result += new if isinstance(new, list) else [new]
        return result

    # Conditions

    def visit_If(self, node):
        node.test = self.condition(node.test, "if")
        node.body, node.orelse = self.block(node.body), self.block(node.orelse)
        return node

    def condition(self, node, kind, prefix=""):
        """An instrumented condition."""
        if self.target.constant(node) is not None:
            return node
        text = prefix + ast.unparse(node)
        if isinstance(node, ast.BoolOp):
            if kind != "condition":
                site = self.add(Condition, [kind], node, text, False)
            node.values = [self.condition(value, "condition") for value in node.values]
            return self.flags(site, node) if kind != "condition" else node
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not):
            node.operand = self.condition(node.operand, kind, prefix)
            return node
        ordered = isinstance(node, ast.Compare) and type(node.ops[0]) in _EDGES
        site = self.add(Condition, [kind], node, text, ordered)
        self.generic_visit(node)
        return self.edges(site, node) if ordered else self.flags(site, node)

    def flags(self, site, node):
        return expression(f"(({site.name('T')} := 1) if condition else ({site.name('F')} := 0))",
                          condition=node)

    def edges(self, site, node):
        t, f, a, b = (site.name(letter) for letter in "TFAB")
        low, holds = _EDGES[type(node.ops[0])]
        edges = (f"(({a} := 1) if {holds} else ({b} := 0)) if {low} <= (gap := left - right) "
                 f"<= {low + 1} else (({t} := 1) if {holds} else ({f} := 0))")
        return expression(f"({edges})", left=node.left, right=node.comparators[0])

    def visit_Compare(self, node):
        return self.condition(node, "condition")

    def visit_BoolOp(self, node):
        return self.condition(node, "condition")

    # Loops

    def visit_While(self, node):
        text = ast.unparse(node.test)
        counts = coverage_elements.counts_of_loop(node.test)
        node.test = self.condition(node.test, "while")
        site = self.add(Loop, ["loop"], node, text, counts)
        turns = f"turns{site.number}"
        node.body = ast.parse(f"{turns} = {turns} + 1").body + self.block(node.body)
        record = ast.parse(f"{site.name('H')}[{turns} if {turns} < 64 else 64] = 1").body
        return ast.parse(f"{turns} = 0").body + [ast.Try([node], [], [], record)]

    def visit_For(self, node):
        items = node.iter
        if self.target.constant(items) is None:
            site = self.add(Loop, ["for"], node, ast.unparse(items))
            node.iter = expression(f"{site.name('L')}(items)", items=self.visit(items))
        node.body = self.block(node.body)
        return node

    # Expressions

    def visit_Call(self, node):
        if not isinstance(node.func, ast.Name):
            return self.generic_visit(node)
        name = node.func.id
        if name in RULES:
            node.args[0] = self.condition(node.args[0], name, f"{node.args[1].value} ")
            return node
        if self.target.is_integer_function(name):
            new = self.target.clone(self.where, name, node)
            node.args = [self.visit(a) for a in node.args]
            return ast.Call(ast.Name(new, ast.Load()), node.args, [])
        return self.generic_visit(node)

    def visit_BinOp(self, node):
        if self.target.constant(node) is not None:
            return self.generic_visit(node)
        if isinstance(node.op, ast.Mult) and isinstance(node.left, ast.List):
            return self.generic_visit(node)
        text = ast.unparse(node)
        operator = _ROUNDING.get(type(node.op))
        if operator and (self.detailed or self.target.signs.may_be(node.left, self.where.path)):
            site = self.add(Shift, [], node, text, operator, self.detailed)
            node = self.generic_visit(node)
            new = expression(f"{site.name('S')}(x, n)", x=node.left, n=node.right)
        else:
            new = self.generic_visit(node)
        site = self.add(Value, [], node, text)
        c, d, w = (site.name(letter) for letter in "CDW")
        return expression(f"(wide if {c} <= (wide := value) <= {d} else {w}(wide))", value=new)
