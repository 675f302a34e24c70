"""The pseudo-code of spec/*.md, checked and translated to Python functions (clause 4 of spec/)."""

import ast
import contextlib
import gc
import pathlib
import re

_HEADING = re.compile(r"#{1,6}\s+(?:Annex\s+)?((?:\d+|[A-Z])(?:\.\d+)*)\b")
_GIVEN_VARIABLES = ("StreamBytes",)
_GIVEN_FUNCTIONS = ("require", "supported", "inflates_to", "output_bytes", "output_attributes")
_PYTHON_FUNCTIONS = {"len": len, "range": range}
_BIT_DESCRIPTORS = ("u", "ue", "se")
_INLINED = "__"  # within the names of local variables of inlined functions
_PARSING_PROCESS = "9"  # its blocks contain no syntax elements

_STATEMENTS = (ast.FunctionDef, ast.Assign, ast.If, ast.While, ast.For, ast.Return, ast.Break,
               ast.Continue, ast.Expr)
_EXPRESSIONS = (ast.Constant, ast.Name, ast.List, ast.Call, ast.Subscript, ast.Compare, ast.BoolOp,
                ast.BinOp, ast.UnaryOp)
_OPERATORS = (ast.Add, ast.Sub, ast.Mult, ast.FloorDiv, ast.Mod, ast.LShift, ast.RShift,
              ast.BitAnd, ast.BitOr, ast.BitXor, ast.USub, ast.Not, ast.And, ast.Or, ast.Eq,
              ast.NotEq, ast.Lt, ast.LtE, ast.Gt, ast.GtE)
_PARTS = (ast.Module, ast.arguments, ast.arg, ast.Load, ast.Store)


class SpecError(Exception):
    """A block of pseudo-code that is not what clause 4 allows."""


def is_global(name):
    return name[0].isupper() or "_" in name


def is_descriptor(name):
    return name in _BIT_DESCRIPTORS or name in ("ae", "bypass") or name.startswith("ae_")


def blocks(folder):
    """(file name, line of the first code line, clause number, text) of every rlpc block."""
    for path in sorted(pathlib.Path(folder).glob("*.md")):
        clause = ""
        fence = None
        first, lines = 0, []
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
            if line.startswith("```"):
                if fence == "rlpc":
                    yield path.name, first, clause, "\n".join(lines) + "\n"
                fence = line[3:].strip() if fence is None else None
                first, lines = number + 1, []
            elif fence is not None:
                lines.append(line)
            elif _HEADING.match(line):
                clause = _HEADING.match(line).group(1)
        if fence is not None:
            raise SpecError(f"{path.name}: a block is not closed")


class _Subset(ast.NodeVisitor):
    """Complains about everything that clause 4.3 does not list."""

    def __init__(self, file):
        self.file = file

    def fail(self, node, what):
        raise SpecError(f"{self.file}:{getattr(node, 'lineno', '?')}: {what}")

    def generic_visit(self, node):
        if not isinstance(node, _STATEMENTS + _EXPRESSIONS + _OPERATORS + _PARTS):
            self.fail(node, f"{type(node).__name__} is not in the pseudo-code language")
        super().generic_visit(node)

    def visit_Module(self, node):
        for statement in node.body:
            if not isinstance(statement, (ast.FunctionDef, ast.Assign)):
                self.fail(statement, "a block has functions and assignments only")
            if isinstance(statement, ast.Assign):
                self.visit_target(statement.targets[0], statement, constant=True)
        self.generic_visit(node)

    def visit_FunctionDef(self, node):
        a = node.args
        if (node.decorator_list or node.returns or a.defaults or a.vararg or a.kwarg
                or a.kwonlyargs or a.posonlyargs):
            self.fail(node, "parameters are plain names")
        for argument in a.args:
            if argument.annotation or is_global(argument.arg):
                self.fail(node, f"parameter {argument.arg}: a lower-case word is expected")
        for statement in node.body:
            if isinstance(statement, ast.FunctionDef):
                self.fail(statement, "a function within a function")
        self.generic_visit(node)

    def visit_target(self, target, statement, constant=False):
        if isinstance(target, ast.Subscript) and not constant:
            while isinstance(target, ast.Subscript):
                target = target.value
        if not isinstance(target, ast.Name):
            self.fail(statement, "the target is a name or an element of a list")
        if constant and not is_global(target.id):
            self.fail(statement, f"{target.id}: a constant begins with a capital letter")

    def visit_Assign(self, node):
        if len(node.targets) != 1:
            self.fail(node, "an assignment has one target")
        self.visit_target(node.targets[0], node)
        self.generic_visit(node)

    def visit_For(self, node):
        if node.orelse or not isinstance(node.target, ast.Name) or is_global(node.target.id):
            self.fail(node, "for: one lower-case word is expected, and no else")
        self.generic_visit(node)

    def visit_While(self, node):
        if node.orelse:
            self.fail(node, "while has no else")
        self.generic_visit(node)

    def visit_Expr(self, node):
        if not isinstance(node.value, ast.Call):
            self.fail(node, "an expression is not a statement")
        self.generic_visit(node)

    def visit_Call(self, node):
        function = node.func
        if isinstance(function, ast.Attribute) and function.attr == "append":
            self.visit(function.value)
        elif not isinstance(function, ast.Name):
            self.fail(node, "a call names a function, or is list.append( )")
        if node.keywords:
            self.fail(node, "arguments have no names")
        rule = isinstance(function, ast.Name) and function.id in ("require", "supported")
        for argument in node.args[:1] if rule else node.args:
            self.visit(argument)
        if rule and (len(node.args) != 2 or not isinstance(node.args[1], ast.Constant)
                     or not isinstance(node.args[1].value, str)):
            self.fail(node, "the second argument is a rule id")

    def visit_Constant(self, node):
        if type(node.value) is not int:
            self.fail(node, f"{node.value!r} is not an integer")

    def visit_Compare(self, node):
        if len(node.ops) != 1:
            self.fail(node, "a comparison has two sides")
        self.generic_visit(node)

    def visit_BinOp(self, node):
        if isinstance(node.op, ast.Mult) and isinstance(node.left, ast.List):
            if len(node.left.elts) != 1 or isinstance(node.left.elts[0], ast.List):
                self.fail(node, "only a list of one integer is repeated")
        self.generic_visit(node)


def _stored_names(node):
    names = []
    for part in ast.walk(node):
        if isinstance(part, ast.Name) and isinstance(part.ctx, ast.Store):
            names.append(part.id)
    return names


def _base_name(target):
    while isinstance(target, ast.Subscript):
        target = target.value
    return target.id


class _Inliner(ast.NodeTransformer):
    """Replaces statements F(args) by the body of F, where F is short and returns nothing."""

    MAX_STATEMENTS = 6

    def __init__(self, functions):
        self.bodies = {}
        self.count = 0
        for name, (node, _) in functions.items():
            parts = list(ast.walk(node))
            calls = [p for p in parts if isinstance(p, ast.Call) and isinstance(p.func, ast.Name)
                     and p.func.id not in _PYTHON_FUNCTIONS]
            if (not calls and sum(isinstance(p, ast.stmt) for p in parts) <= self.MAX_STATEMENTS
                    and not any(isinstance(p, (ast.Return, ast.For)) for p in parts)):
                self.bodies[name] = node

    def visit_Expr(self, node):
        call = node.value
        if not (isinstance(call.func, ast.Name) and call.func.id in self.bodies):
            return node
        callee = self.bodies[call.func.id]
        if not all(isinstance(a, (ast.Name, ast.Constant)) for a in call.args):
            return node
        self.count += 1
        arguments = dict(zip((a.arg for a in callee.args.args), call.args))
        stored = set(_stored_names(callee))
        if stored & (set(arguments) | {a.id for a in call.args if isinstance(a, ast.Name)}):
            return node
        suffix = f"{_INLINED}{self.count}"

        class Rename(ast.NodeTransformer):
            def visit_Name(self, name):
                if name.id in arguments:
                    return ast.copy_location(arguments[name.id], name)
                if name.id in stored and not is_global(name.id):
                    return ast.copy_location(ast.Name(name.id + suffix, name.ctx), name)
                return name

        body = ast.parse(ast.unparse(callee)).body[0].body
        return [ast.copy_location(Rename().visit(statement), node) for statement in body]


class _Tracer(ast.NodeTransformer):
    """Reports syntax elements: trace_begin(kind) before, trace_element(name, value) after."""

    def visit_Assign(self, node):
        call = node.value
        if not (isinstance(call, ast.Call) and isinstance(call.func, ast.Name)
                and is_descriptor(call.func.id)):
            return node
        name = _base_name(node.targets[0])
        value = ast.parse(ast.unparse(node.targets[0]), mode="eval").body
        kind = 0 if call.func.id in _BIT_DESCRIPTORS else 1
        return [_call("trace_begin", ast.Constant(kind)), node,
                _call("trace_element", ast.Constant(name), value)]


class _WidthChecker(ast.NodeTransformer):
    """Checks every result of arithmetic."""

    def visit_BinOp(self, node):
        self.generic_visit(node)
        if isinstance(node.op, ast.Mult) and isinstance(node.left, ast.List):
            return node
        return ast.Call(ast.Name("checked_width", ast.Load()), [node], [])


def _call(name, *arguments):
    return ast.Expr(ast.Call(ast.Name(name, ast.Load()), list(arguments), []))


class Program:
    """All blocks of a folder. functions: name -> (ast, clause); constants: in order."""

    def __init__(self, folder):
        self.functions = {}
        self.constants = []
        self.variables = set(_GIVEN_VARIABLES)
        self._places = {}
        self._codes = {}  # what code( ) made without a transform
        for file, line, clause, text in blocks(folder):
            self._read(file, line, clause, text)
        self._check_names()

    def _read(self, file, line, clause, text):
        try:
            tree = ast.parse(text)
        except SyntaxError as error:
            place = f"{file}:{line + (error.lineno or 1) - 1}"
            raise SpecError(f"{place}: {error.msg}") from error
        ast.increment_lineno(tree, line - 1)
        _Subset(file).visit(tree)
        for statement in tree.body:
            self._places[statement] = f"{file}:{statement.lineno}"
            if isinstance(statement, ast.FunctionDef):
                if statement.name in self.functions:
                    raise SpecError(f"{file}:{statement.lineno}: {statement.name} is defined "
                                    "a second time")
                self.functions[statement.name] = (statement, clause)
            else:
                self.constants.append(statement)
            self.variables |= {n for n in _stored_names(statement) if is_global(n)}

    def _check_names(self):
        functions = set(self.functions) | set(_GIVEN_FUNCTIONS) | set(_PYTHON_FUNCTIONS)
        for clash in sorted((self.variables | set(_GIVEN_FUNCTIONS) | set(_PYTHON_FUNCTIONS))
                            & set(self.functions)):
            raise SpecError(f"{clash} is a function and something else")
        for node in [f for f, _ in self.functions.values()] + self.constants:
            local = set(_stored_names(node))
            if isinstance(node, ast.FunctionDef):
                local |= {a.arg for a in node.args.args}
            parts = list(ast.walk(node))
            calls = [p for p in parts if isinstance(p, ast.Call) and isinstance(p.func, ast.Name)]
            called = {p.func for p in calls}
            for part in parts:
                if not isinstance(part, ast.Name):
                    continue
                if part in called:
                    known = part.id in functions
                else:
                    known = part.id in local or part.id in self.variables
                if not known:
                    raise SpecError(f"{self._places[node]}: {part.id} is not defined")
            for call in calls:
                self._check_arguments(node, call)

    def _check_arguments(self, node, call):
        name = call.func.id
        if name not in self.functions:
            return
        expected = len(self.functions[name][0].args.args)
        if len(call.args) != expected:
            raise SpecError(f"{self._places[node]}: {name} takes {expected} argument(s)")

    def code(self, trace=False, widths=False, transform=None):
        """The program as a code object, for run( ).

        transform takes functions and returns what runs in their place.
        """
        if transform is None and (trace, widths) in self._codes:
            return self._codes[trace, widths]
        functions = transform(self.functions) if transform else self.functions
        inliner = _Inliner(functions)
        module = ast.Module([], [])
        for node, clause in functions.values():
            node = ast.parse(ast.unparse(node)).body[0]  # a copy
            if trace and clause.split(".")[0] != _PARSING_PROCESS:
                node = _Tracer().visit(node)
            node = inliner.visit(node)
            if widths:
                node = _WidthChecker().visit(node)
            changed = sorted({n for n in _stored_names(node)
                              if is_global(n) and _INLINED not in n})
            if changed:
                node.body.insert(0, ast.Global(changed))
            module.body.append(node)
        module.body += self.constants
        ast.fix_missing_locations(module)
        code = compile(module, "spec", "exec")
        if transform is None:
            self._codes[trace, widths] = code
        return code

    def compile(self, given, trace=False, widths=False):
        """The variables and functions of the program as a dictionary.

        given: StreamBytes and the functions of clause 4.5; with trace, also trace_begin and
        trace_element; with widths, also checked_width.
        """
        return run(self.code(trace, widths), given)


@contextlib.contextmanager
def without_collections():
    """Looking for cycles in memory takes longer than decoding large streams, whose lists have
    none."""
    enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if enabled:
            gc.enable()


def run(code, given):
    """Definitions of a code object of a program, as a dictionary; given: as for compile( )."""
    namespace = {"__builtins__": dict(_PYTHON_FUNCTIONS)}
    namespace.update(given)
    exec(code, namespace)  # noqa: S102
    return namespace
