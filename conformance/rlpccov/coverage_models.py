"""Names of the models (9.4) that a program makes, and the bins decoded with each.

A model gets two more elements: whether it has decoded a 0, and a 1. Lists of models get their
names where the program assigns what a function has made of them to a variable.
"""

import ast

import spec_program
from coverage_sites import Context

NEW_MODEL = "NewModel"
_BINS = 3  # index after the three elements of a model


def record_bins(function):
    """The body of ae( model ), with each bin noted in the model."""
    model = function.args.args[0].arg
    note = ast.parse(f"{model}[{_BINS} + wide] = 1").body

    class Returns(ast.NodeTransformer):
        def visit_Return(self, node):
            value = ast.Assign([ast.Name("wide", ast.Store())], node.value)
            return [value, *note, ast.Return(ast.Name("wide", ast.Load()))]
    return Returns().visit(ast.Module(function.body, [])).body


def instrument(instrumenter, statement):
    """Instruments the statement to name the models that it assigns to a variable."""
    models = instrumenter.target.models
    makes = [p for p in ast.walk(statement.value) if isinstance(p, ast.Call)
             and isinstance(p.func, ast.Name) and p.func.id in models.makers]
    if not makes or instrumenter.where.path in models.makers:
        return
    key = len(models.groups)
    models.groups.append([])
    for name, members in models.expected(statement, key):
        site = instrumenter.add(Context, [], statement, name, members)
        models.groups[key].append(site)
    statement.value = ast.Call(ast.Name("CoverMade", ast.Load()),
                               [ast.Constant(key), statement.value], [])


class Models:
    """Knows the functions that make models, and follows the models of a run."""

    def __init__(self, target):
        self.target = target
        functions = target.program.functions
        self.makers = {NEW_MODEL} & set(functions)
        grown = True
        while grown:
            more = {n for n, (f, _) in functions.items() if self._makes(f)} - self.makers
            grown = bool(more)
            self.makers |= more
        self.labels = {n: self._labels(functions[n][0]) for n in self.makers}
        self.groups = []
        self._sizes = {}

    def _makes(self, function):
        return (any(isinstance(p, ast.Return) and p.value is not None
                    for p in ast.walk(function))
                and set(self.target._calls(function)) & self.makers)

    @staticmethod
    def _labels(function):
        """Names of the parts of what a function returns, such as [prefixes, tops]."""
        for part in ast.walk(function):
            if (isinstance(part, ast.Return) and isinstance(part.value, ast.List)
                    and all(isinstance(e, ast.Name) for e in part.value.elts)):
                return [e.id for e in part.value.elts]
        return None

    def expected(self, statement, key):
        """(name, members) of the models that a statement makes; members as found in a run."""
        names = {p.id for p in ast.walk(statement.value) if isinstance(p, ast.Name)}
        largest = self.target.settings.get("largest", {})
        varies = bool(names & set(largest))
        variables = dict(self.target.constants, **largest)
        made = eval(ast.unparse(statement.value), variables)  # noqa: S307
        base = ast.unparse(statement.targets[0])
        self._sizes[base] = len(made)
        label = self._label(statement.value)
        found = {}
        for path in self._paths(made):
            name = base + self._text(path, label)
            if varies and path:
                first = 1 << (path[-1].bit_length() - 1) if path[-1] else 0
                last = max(first, 2 * first - 1)
                span = f"[{first}-{last}]" if last > first else f"[{first}]"
                name = base + self._text(path[:-1], label) + span
            found.setdefault(name, set()).add((key, path))
        return found.items()

    def size(self, node):
        """The number of models of a list that the program makes."""
        if ast.unparse(node) in self._sizes:
            return self._sizes[ast.unparse(node)]
        for function, _ in self.target.program.functions.values():
            for part in ast.walk(function):
                if (isinstance(part, ast.Assign)
                        and ast.unparse(part.targets[0]) == ast.unparse(node)):
                    return len(eval(ast.unparse(part.value), dict(self.target.constants)))
        raise spec_program.SpecError(f"{ast.unparse(node)}: models that nothing makes")

    def _label(self, node):
        return self.labels.get(node.func.id) if isinstance(node, ast.Call) else None

    @staticmethod
    def _text(path, label):
        if path and label:
            return f".{label[path[0]]}" + "".join(f"[{i}]" for i in path[1:])
        return "".join(f"[{i}]" for i in path)

    def _paths(self, made):
        if made and isinstance(made[0], int):
            return [()]
        return [(i, *path) for i, part in enumerate(made) for path in self._paths(part)]

    # A run

    def given(self, namespace):
        """CoverMade( ) names models, and records what the models that it replaces have decoded."""
        current = {}
        bins = (set(), set())

        def collect():
            for key, made in current.items():
                _collect(bins, (key,), made)

        def made(key, value):
            if key in current:
                _collect(bins, (key,), current[key])
            current[key] = _widened(value)
            return value

        return {"CoverMade": made, "CoverCollect": collect, "CoverBins": bins}


def _widened(made):
    """Gives every model in a list of lists its two more elements."""
    if made and isinstance(made[0], int):
        made += [0, 0]
    else:
        for part in made:
            _widened(part)
    return made


def _collect(bins, path, made):
    if made and isinstance(made[0], int):
        for bin in (0, 1):
            if made[_BINS + bin]:
                bins[bin].add((path[0], path[1:]))
    else:
        for i, part in enumerate(made):
            _collect(bins, (*path, i), part)
