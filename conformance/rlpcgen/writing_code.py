"""The program of the specification, changed to write each syntax element before it reads it."""

import ast
import functools
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "specdec"))
import spec_program


class _ElementCalls(ast.NodeTransformer):
    """target = descriptor(args) becomes target = write_element(name, indices, descriptor, args)."""

    def visit_Assign(self, node):
        call = node.value
        if not (isinstance(call, ast.Call) and isinstance(call.func, ast.Name)
                and spec_program.is_descriptor(call.func.id)):
            return node
        target, indices = node.targets[0], []
        while isinstance(target, ast.Subscript):
            indices.insert(0, ast.parse(ast.unparse(target.slice), mode="eval").body)
            target = target.value
        arguments = [ast.Constant(target.id), ast.List(indices, ast.Load()),
                     ast.Constant(call.func.id)] + call.args
        node.value = ast.Call(ast.Name("write_element", ast.Load()), arguments, [])
        return node


def _element_calls(functions):
    """The functions of a program with their elements written; clause 9 contains none."""
    changed = {}
    for name, (node, clause) in functions.items():
        if clause.split(".")[0] != "9":
            node = _ElementCalls().visit(ast.parse(ast.unparse(node)).body[0])
        changed[name] = (node, clause)
    return changed


@functools.lru_cache(maxsize=None)
def writing_code(program):
    """The program that StreamWriter runs; made once for many streams."""
    return program.code(transform=_element_calls)


def element_names(program):
    """Names of all syntax elements of a program, with their descriptors."""
    names = {}
    for node, clause in program.functions.values():
        if clause.split(".")[0] == "9":
            continue
        for part in ast.walk(node):
            if (isinstance(part, ast.Assign) and isinstance(part.value, ast.Call)
                    and isinstance(part.value.func, ast.Name)
                    and spec_program.is_descriptor(part.value.func.id)):
                names[spec_program._base_name(part.targets[0])] = part.value.func.id
    return names
