#!/usr/bin/env python3
"""Tests of the checks of the tables in Annexes D and E."""

import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

import check_index
import check_state
from test_checks import TreeTest


class Index(TreeTest):
    TREE = {"spec/06.md": "# 6 Syntax\n## 6.1 Head\n```rlpc\ndef head():\n    Sizes = []\n"
                          "    for i in range(2):\n        size_flag = u(1)\n"
                          "        Sizes.append(size_flag)\n    Forget()\n```\n",
            "spec/07.md": "# 7 Semantics\n## 7.1 Head\nHere.\n### 7.1.2 Size\n"
                          "**size_flag** is one.\n",
            "spec/08.md": "# 8 Decoding\n## 8.2 End\n```rlpc\ndef Forget():\n    a = 1\n"
                          "    Sizes[0] = a\n    size_flag = 0\n    Last = a + Sizes[1]\n```\n"}
    TABLES = {"functions": "| function | clause |\n|---|---|\n"
                           "| Forget( ) | 8.2 |\n| head( ) | 6.1 |\n",
              "elements": "| syntax element | syntax | semantics |\n|---|---|---|\n"
                          "| size_flag | 6.1 | 7.1.2 |\n",
              "variables": "| variable | set in | read in |\n|---|---|---|\n"
                           "| Last | 8.2 |  |\n| Sizes | 6.1, 8.2 | 8.2 |\n"}

    def tree(self, **changed):
        annex = "".join(f"<!-- begin: {name} (x) -->\n{table}<!-- end: {name} -->\n"
                        for name, table in {**self.TABLES, **changed}.items())
        return {**self.TREE, str(check_index.ANNEX): "# Annex D Index\n" + annex}

    def test_names_are_listed(self):
        self.assert_clean(check_index.check, self.tree())

    def test_tables_that_are_not_up_to_date(self):
        self.assert_one(check_index.check, self.tree(variables=""), "not up to date")
        more = self.TABLES["functions"] + "| Gone( ) | 8.3 |\n"
        self.assert_one(check_index.check, self.tree(functions=more), "not up to date")

    def test_a_table_without_marks(self):
        tree = self.tree()
        tree[str(check_index.ANNEX)] = tree[str(check_index.ANNEX)].replace("end: el", "end: l")
        self.assert_one(check_index.check, tree, "no marks `begin: elements`")

    def test_an_element_that_is_explained_nowhere(self):
        tree = {**self.tree(elements=self.TABLES["elements"].replace("7.1.2", "")),
                "spec/07.md": "# 7 Semantics\n"}
        self.assert_one(check_index.check, tree, "size_flag is in bold nowhere")


class State(TreeTest):
    SPEC = ("# 6 Syntax\n## 6.1 Head\n```rlpc\ndef head():\n    Sizes = []\n    near_flag = u(1)\n"
            "    far_flag = 0\n    wide_flag = u(1)\n    far_flag = u(1)\n"
            "    Sizes.append(near_flag)\n    Use()\n```\n"
            "## 6.2 Use\n```rlpc\ndef Use():\n    Sizes[0] = far_flag + wide_flag\n```\n")
    VARIABLES = "| a unit | head( ) (6.1) | Sizes |\n"
    ELEMENTS = "| a unit | head( ) (6.1) | wide_flag, far_flag |\n"

    def tree(self, variables=VARIABLES, elements=ELEMENTS, spec=SPEC):
        return {"spec/06.md": spec, str(check_state.ANNEX):
                f"{variables}\n<!-- begin: elements (x) -->\n| a | b | c |\n|---|---|---|\n"
                f"{elements}<!-- end: elements -->\n"}

    def test_all_that_outlives_its_function_is_listed(self):
        self.assert_clean(check_state.check, self.tree())
        self.assert_one(check_state.check, self.tree(variables=""), "Sizes is missing")
        self.assert_one(check_state.check, self.tree(elements=""),
                        "head( ) reads wide_flag, far_flag, and has no row")

    def test_variables_that_are_wrong(self):
        for place, complaint in {"head( ) (6.1) | Lost": "gives Lost no value",
                                 "head( ) (6.1) | far_flag": "does not outlive a function",
                                 "Use( ) (6.2) | Sizes": "Use( ) gives Sizes no",
                                 "Use( ) (6.1) | Sizes": "6.1 has no Use( )"}.items():
            more = f"| a unit | {place} |\n"
            found = self.complaints(check_state.check, self.tree(self.VARIABLES + more))
            self.assertIn(complaint, " ".join(found))

    def test_elements_that_are_wrong(self):
        for row, complaint in {"| a unit | Use( ) (6.2) |  |\n": "Use( ) reads no element",
                               "| a unit | Gone( ) |  |\n": "Gone( ) reads no element",
                               "| a unit | far_flag |\n": "a row without a function",
                               self.ELEMENTS: "head( ) is in two rows"}.items():
            found = self.complaints(check_state.check, self.tree(elements=self.ELEMENTS + row))
            self.assertIn(complaint, " ".join(found))
        tree = self.tree()
        tree[str(check_state.ANNEX)] = tree[str(check_state.ANNEX)].replace("end: el", "end: l")
        self.assertIn("no marks", " ".join(self.complaints(check_state.check, tree)))

    def test_a_new_element_takes_one_command(self):
        spec = self.SPEC.replace("    near", "    new_flag = u(1)\n    near").replace(
            "= far_flag +", "= new_flag + far_flag +")
        self.assert_one(check_state.check, self.tree(spec=spec), "not up to date: scripts/index")
        for stale in ("| a unit | head( ) |  |\n", self.ELEMENTS.replace("6.1", "6.2"),
                      self.ELEMENTS.replace("far_flag", "near_flag")):
            self.assert_one(check_state.check, self.tree(elements=stale), "scripts/index")
            with tempfile.TemporaryDirectory() as folder:
                root = pathlib.Path(folder)
                for name, text in self.tree(elements=stale, spec=spec).items():
                    (root / name).parent.mkdir(exist_ok=True)
                    (root / name).write_text(text, encoding="utf-8")
                fresh, complaints = check_state.updated(root)
            self.assertEqual(complaints, [])
            self.assertIn("| a unit | head( ) (6.1) | new_flag, wide_flag, far_flag |\n", fresh)
            self.assert_clean(check_state.check,
                              {**self.tree(spec=spec), str(check_state.ANNEX): fresh})


if __name__ == "__main__":
    unittest.main()
