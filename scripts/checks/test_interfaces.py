#!/usr/bin/env python3
"""Faults in messages, names of attributes and public headers, planted in a copy of the real tree
as test_guards.py does, and the complaint that each must cause."""

import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

import check_api
import check_attributes
import check_settings
import test_guards

setUpModule = test_guards.setUpModule
tearDownModule = test_guards.tearDownModule
RealTree = test_guards.RealTree


class Settings(RealTree):
    ENCODER = "encoder/codec/sequence/check_settings.cpp"
    TABLE = "encoder/programs/setting_options.h"

    def test_the_tree_is_clean(self):
        self.assertEqual(check_settings.check(self.root)[0], [])

    def test_libraries_name_no_options(self):
        for name in (self.ENCODER, "decoder/meshes/gltf/gltf_sink.cpp",
                     "common/files/output_file.cpp", "decoder/c_api/rlpc_pose.cpp"):
            with self.subTest(name=name):
                self.complaint(check_settings.check, name,
                               lambda text: text + 'const char* s = "use a smaller "\n"--gof";\n',
                               name, "names the option --gof")

    def test_settings_of_messages_have_options(self):
        self.complaint(check_settings.check, self.ENCODER,
                       lambda text: text + 'const char* s = "a \'new_setting = 3\'";\n',
                       self.ENCODER, "'new_setting = 3' has no option in " + self.TABLE)
        with self.planted(self.TABLE,
                          lambda text: text.replace('    {"gof_frames", "--gof"},\n', "")):
            found = check_settings.check(self.root)[0]
        self.assertTrue(found)
        for complaint in found:
            self.assertIn("'gof_frames' has no option", complaint)

    def test_entries_are_settings_and_options(self):
        for entry, words in (('{"gof_frame", "--gof"}', "no setting is called gof_frame"),
                             ('{"rest", "--rests"}', "no program has the option --rests")):
            with self.subTest(entry=entry):
                self.complaint(check_settings.check, self.TABLE,
                               lambda text, entry=entry: text + "// " + entry + "\n",
                               self.TABLE, words)

    def test_a_tree_without_messages_or_tables_is_reported(self):
        with self.without("encoder/programs"):
            self.assertTrue(any("has no entries" in complaint
                                for complaint in check_settings.check(self.root)[0]))


class Api(RealTree):
    HEADER = "decoder/c_api/rlpc_c_decoder.h"

    def test_the_tree_is_clean(self):
        self.assertEqual(check_api.check(self.root)[0], [])

    def test_examples_are_compiled(self):
        for name, words in ((self.HEADER, "has no such example"),
                            ("encoder/frame_encoder.h", "has no such example"),
                            ("scripts/checks/consumer/examples.c", "has no such example")):
            with self.subTest(name=name), self.planted(name, lambda text: text.replace(
                    "rlpc_decoder_close(decoder);", "rlpc_decoder_free(decoder);", 1).replace(
                        "encoder->finish();", "encoder->end();", 1)):
                found = check_api.check(self.root)[0]
            self.assertEqual(len(found), 2, found)  # of the header, and of the program
            for complaint in found:
                self.assertIn(words, complaint)

    def test_an_example_of_its_own_is_found(self):
        self.complaint(check_api.check, "decoder/describe_error.h",
                       lambda text: "// Usage:\n//   print(describe_error(error));\n" + text,
                       "decoder/describe_error.h", "has no such example")

    def test_new_names_state_their_version(self):
        function = "RLPC_API void rlpc_new(void);\n"
        for added, words in (("\n// Does it.\n" + function, "does not say since which version"),
                             ("\n// Does it. Since 1.2.\n" + function, None)):
            with self.planted(self.HEADER, lambda text, added=added: text + added):
                found = check_api.check(self.root)[0]
            self.assertEqual(len(found), 1 if words else 0, found)
            self.assertIn(words or "", "".join(found))
        self.complaint(check_api.check, self.HEADER, lambda text: text.replace(
            "  uint32_t max_layers;\n", "  uint32_t max_layers;\n  uint32_t extra[2];\n"),
            "rlpc_decode_options.extra does not say since")

    def test_names_of_the_first_version_stay(self):
        with self.planted(self.HEADER,
                          lambda text: text.replace("rlpc_decoder_seek(", "rlpc_decoder_go(")):
            found = check_api.check(self.root)[0]
        self.assertTrue(any("rlpc_decoder_seek is declared nowhere" in text for text in found))


class Attributes(RealTree):
    def test_the_tree_is_clean(self):
        self.assertEqual(check_attributes.check(self.root)[0], [])

    def test_literals_are_found(self):
        for name, line in (("encoder/meshes/gltf/attributes.cpp", 'auto a = find("uv0");'),
                           ("decoder/surface/drawn_mesh.cpp", 'bool b = name == "normal";'),
                           ("encoder/meshes/obj/obj_reader.cpp", 'add("material");'),
                           ("decoder/web/viewer/viewer.js", 'sets.get("material");'),
                           ("decoder/web/package/src/three.js", "`uv${number}`;")):
            with self.subTest(name=name):
                self.complaint(check_attributes.check, name,
                               lambda text, line=line: line + "\n" + text, f"{name}:1",
                               "Table F-1")

    def test_names_are_those_of_the_specification(self):
        for name, old, new in (
                (check_attributes.HEADER, 'kPartName = "part"', 'kPartName = "parts"'),
                ("spec/annex-f-attributes.md", "| `part` |", "| `tangent` |")):
            with self.planted(name, lambda text, old=old, new=new: text.replace(old, new)):
                found = check_attributes.check(self.root)[0]
            self.assertTrue(any("differ from those of Table F-1" in text for text in found), found)


if __name__ == "__main__":
    unittest.main()
