"""Finds the values of the program that can be negative, as far as its text shows."""

import ast

import spec_program


class Signs:
    """Starts from "nothing is negative" and follows every assignment until nothing changes."""

    def __init__(self, program):
        self.functions = {name: node for name, (node, _) in program.functions.items()}
        self.negative = set()  # (function or "", variable), and (function, None) for results
        size = -1
        while size != len(self.negative):
            size = len(self.negative)
            for constant in program.constants:
                self._statement("", constant)
            for name, node in self.functions.items():
                for part in ast.walk(node):
                    self._statement(name, part)

    def _variable(self, function, name):
        return ("" if spec_program.is_global(name) else function, name)

    def _mark(self, function, target):
        while isinstance(target, ast.Subscript):
            target = target.value
        if isinstance(target, ast.Name):
            self.negative.add(self._variable(function, target.id))

    def _statement(self, function, node):
        if isinstance(node, ast.Assign) and self.may_be(node.value, function):
            self._mark(function, node.targets[0])
        elif isinstance(node, ast.Return) and node.value is not None:
            if self.may_be(node.value, function):
                self.negative.add((function, None))
        elif isinstance(node, ast.For):
            if self.may_be(node.iter, function):
                self._mark(function, node.target)
            if (function, node.target.id) in self.negative:  # an element that was changed
                self._mark(function, node.iter)
        elif isinstance(node, ast.Call):
            self._call(function, node)

    def _call(self, function, node):
        if isinstance(node.func, ast.Attribute):
            if self.may_be(node.args[0], function):
                self._mark(function, node.func.value)
        elif node.func.id in self.functions:
            callee = self.functions[node.func.id]
            for parameter, argument in zip(callee.args.args, node.args):
                if self.may_be(argument, function):
                    self.negative.add((node.func.id, parameter.arg))
                elif ((node.func.id, parameter.arg) in self.negative
                      and self._changes(callee, parameter.arg)):
                    self._mark(function, argument)

    @staticmethod
    def _changes(callee, parameter):
        """Whether a function changes elements of a list that it is given."""
        return any(isinstance(p, ast.Assign) and isinstance(p.targets[0], ast.Subscript)
                   and spec_program._base_name(p.targets[0]) == parameter
                   for p in ast.walk(callee))

    def may_be(self, node, function):
        """Whether the value of an expression, or an element of it, can be negative."""
        if isinstance(node, ast.Constant):
            return node.value < 0
        if isinstance(node, ast.Name):
            return self._variable(function, node.id) in self.negative
        if isinstance(node, ast.Subscript):
            return self.may_be(node.value, function)
        if isinstance(node, ast.List):
            return any(self.may_be(e, function) for e in node.elts)
        if isinstance(node, ast.Call):
            name = node.func.id if isinstance(node.func, ast.Name) else None
            if name == "range":
                return any(self.may_be(a, function) for a in node.args)
            return (name, None) in self.negative
        if isinstance(node, ast.UnaryOp):
            return not isinstance(node.op, ast.Not)
        if isinstance(node, ast.BinOp):
            return self._operator(node, function)
        return False  # comparisons

    def _operator(self, node, function):
        left = self.may_be(node.left, function)
        right = self.may_be(node.right, function)
        if isinstance(node.op, ast.Sub):
            return not ast.unparse(node).startswith("(1 <<") or ast.unparse(node.right) != "1"
        if isinstance(node.op, ast.BitAnd):
            return left and right
        if isinstance(node.op, ast.Mod):
            return False
        if isinstance(node.op, (ast.LShift, ast.RShift, ast.FloorDiv)):
            return left
        return left or right
