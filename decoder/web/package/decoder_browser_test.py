#!/usr/bin/env python3
"""RlpcDecoder of the packed package in Chromium.

  decoder_browser_test.py --bin FOLDER

Exit code: 0 passed, 1 failed, 77 if all was skipped.
"""

import collections
import hashlib
import pathlib
import random
import shutil
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "testing"))
from in_scene import InScene
from player_testing import ELEPHANT, STREAMS, float_frames, main, run
from stream_server import StreamServer

HEAD, TAIL = 16384, 4096  # what open() loads first
LIES = 40  # servers of the test with wrong replies
KINDS = ("truncated", "invalid", "unsupported", "limit", "source", "network")  # of their errors


class Decoder(InScene):
    """RlpcDecoder."""

    def test_frames_are_those_of_rlpcdec(self):
        hashes = self.run_script("""
            const decoder = await RlpcDecoder.open('walk.rlpc');
            const hashes = [];
            for await (const frame of decoder.frames()) hashes.push(await sha256(frame.positions));
            decoder.close();
            return hashes;""")
        self.assertEqual(hashes, [self.hash_of(f) for f in range(60)])

    def test_integers_with_origin_and_step_are_the_positions(self):
        differing = self.run_script("""
            const decoder = await RlpcDecoder.open('walk.rlpc');
            const { positions, integers } = await decoder.frame(7, { integers: true });
            const { gridOrigin, gridStep } = decoder;
            return positions.filter((x, i) =>
              Math.fround((integers[i] + gridOrigin[i % 3]) * gridStep) !== x).length;""")
        self.assertEqual(differing, 0)

    def test_what_is_known_of_the_stream(self):
        told = self.run_script("""
            const decoder = await RlpcDecoder.open('walk.rlpc');
            const { info, clips, indices, bounds, metadata } = decoder;
            const frame = await decoder.frame(0);
            const inside = [0, 1, 2].every((c) => bounds.min[c] <= frame.bounds.min[c] &&
              frame.bounds.min[c] < frame.bounds.max[c] && frame.bounds.max[c] <= bounds.max[c]);
            const edges = await decoder.edges();
            return { info, clips, corners: indices.length, inside, edges: edges.length / 2,
                     metadata };""")
        info = told["info"]
        self.assertEqual((info["vertices"], info["triangles"], info["frames"]), (538, 1072, 60))
        self.assertEqual((info["frameRate"], info["duration"]), (30, 59 / 30))
        self.assertEqual((info["profile"], info["level"]), ("Main", 1))
        self.assertEqual(info["bytes"], self.stream.stat().st_size)
        self.assertEqual(told["clips"], [
            {"name": "Walk", "firstFrame": 4, "frames": 12, "duration": 11 / 30},
            {"name": 'Wave "again"', "firstFrame": 20, "frames": 40, "duration": 39 / 30}])
        self.assertEqual(told["corners"], 3 * 1072)
        self.assertEqual(2 * told["edges"], 3 * 1072)  # closed
        self.assertTrue(told["inside"])

    def test_normals_are_those_of_the_triangles(self):
        deviation = self.run_script("""
            const decoder = await RlpcDecoder.open('walk.rlpc');
            const { positions, normals } = await decoder.frame(30, { normals: true });
            const geometry = new THREE.BufferGeometry();
            geometry.setIndex(new THREE.BufferAttribute(decoder.indices, 1));
            geometry.setAttribute('position', new THREE.BufferAttribute(positions, 3));
            geometry.computeVertexNormals();
            return Math.max(...geometry.attributes.normal.array.map((x, i) =>
              Math.abs(x - normals[i])));""")
        self.assertLess(deviation, 1e-3)

    def test_lying_servers_end_in_errors_or_right_frames(self):
        """Most replies are wrong; each call settles, and what is a frame is the right one."""
        hashes = [self.hash_of(f) for f in range(60)]
        outcomes = collections.Counter()
        for seed in range(LIES):
            self.server.lies = random.Random(seed)
            told = self.run_script(f"""
                const settled = (promise) => Promise.race([promise.then((value) => ({{ value }}),
                  (error) => ({{ error: String(error), kind: error.kind ?? '' }})),
                  new Promise((done) => setTimeout(() => done({{ error: 'hangs' }}), 20000))]);
                const opened = await settled(RlpcDecoder.open('walk.rlpc?{seed}'));
                if (opened.error) return [opened];
                const told = [];
                for (const n of [0, 31, 59, 12, 12, 40]) {{
                  const got = await settled(opened.value.frame(n));
                  told.push(got.error ? got : {{ n, hash: await sha256(got.value.positions) }});
                }}
                opened.value.close();
                return told;""")
            for one in told:
                if "hash" in one:
                    self.assertEqual(one["hash"], hashes[one["n"]], f"seed {seed}")
                    outcomes["frame"] += 1
                else:
                    self.assertNotEqual(one["error"], "hangs", f"seed {seed}")
                    self.assertIn(one["kind"], KINDS, f"seed {seed}: {one['error']}")
                    outcomes["error"] += 1
        self.assertGreater(min(outcomes["frame"], outcomes["error"]), 10, outcomes)
        self.server.lies = None
        self.assertEqual(self.run_script("""
            const decoder = await RlpcDecoder.open('walk.rlpc');
            const { positions } = await decoder.frame(59);
            decoder.close();
            return sha256(positions);"""), hashes[59])

    def test_a_seek_loads_one_gof(self):
        gof = self.stream.stat().st_size / 20
        loaded = self.run_script("""
            globalThis.decoder = await RlpcDecoder.open('walk.rlpc');
            return null;""") or self.server.sent()
        self.assertEqual(loaded, HEAD + TAIL)
        self.assertEqual(self.run_script("return sha256((await decoder.frame(40)).positions);"),
                         self.hash_of(40))
        first = self.server.sent() - loaded
        self.assertEqual(len(self.server.requests), 3)
        self.assertLess(first, 1.3 * gof)
        self.run_script("await decoder.frame(39); return null;")
        self.assertEqual(self.server.sent(), loaded + first)  # it is of the same GOF
        print(f"a stream of {self.stream.stat().st_size} bytes, 20 GOFs: open() loads {loaded} "
              f"bytes, a seek {first}")

    def test_the_next_gof_is_loaded_ahead(self):
        self.run_script("""
            globalThis.decoder = await RlpcDecoder.open('walk.rlpc');
            await decoder.frame(39);
            await decoder.frame(40);
            return null;""")
        self.browser.wait_for("new Promise((next) => setTimeout(() => next(true), 500))")
        end = len(self.server.requests)
        self.run_script("await decoder.frame(42); return null;")
        self.assertGreaterEqual(end, 4)
        self.assertEqual(len(self.server.requests), end)

    def test_a_stream_without_an_index_is_loaded_in_few_requests(self):
        stream = self.encode("long.rlpc", "--gof", "all", "--profile", "high", "--lossless", "22")
        frames = float_frames(stream, self.folder)
        self.assertGreater(stream.stat().st_size, 60_000)
        self.assertEqual(self.run_script("""
            const decoder = await RlpcDecoder.open('long.rlpc');
            return sha256((await decoder.frame(30)).positions);"""),
                         hashlib.sha256(frames[30]).hexdigest())
        self.assertLessEqual(len(self.server.requests), 6)

    def test_a_server_without_ranges(self):
        self.server.ranges = False
        result = self.run_script("""
            const steps = [];
            const decoder = await RlpcDecoder.open('walk.rlpc',
              { onProgress: (step) => steps.push(step) });
            const hash = await sha256((await decoder.frame(59)).positions);
            return { hash, last: steps.at(-1) };""")
        self.assertEqual(result["hash"], self.hash_of(59))
        size = self.stream.stat().st_size
        self.assertEqual(result["last"], {"loaded": size, "total": size})
        self.assertEqual(self.server.requests, [("GET", 0, size, 200)])

    def test_frames_come_while_a_server_without_ranges_still_sends(self):
        self.server.ranges = False
        self.server.bytes_per_second = 50_000
        steps = self.run_script("""
            let progress;
            const decoder = await RlpcDecoder.open('walk.rlpc',
              { onProgress: (step) => (progress = step) });
            const steps = [];
            for await (const { positions } of decoder.frames({ last: 20, ahead: 0 })) {
              steps.push([await sha256(positions), progress.loaded]);
            }
            return steps;""")
        self.assertEqual([crc for crc, _ in steps], [self.hash_of(f) for f in range(21)])
        size = self.stream.stat().st_size
        self.assertLess(steps[0][1], 0.5 * size)
        self.assertLess(steps[20][1], 0.8 * size)

    def test_a_server_of_another_origin(self):
        decode = """
            const decoder = await RlpcDecoder.open('ADDRESS/walk.rlpc');
            return sha256((await decoder.frame(33)).positions);"""
        with StreamServer(self.folder) as other:
            decode = decode.replace("ADDRESS", other.address)
            self.assertEqual(self.error_of(decode)["kind"], "network")
            other.is_open = True
            for other.ranges in (True, False):
                other.requests.clear()
                self.assertEqual(self.run_script(decode), self.hash_of(33))
                # It hides Content-Range, so that the size has to be asked for.
                self.assertEqual("HEAD" in [method for method, *_ in other.requests],
                                 other.ranges)

    def test_a_worker_or_module_that_cannot_be_loaded(self):
        error = self.error_of("""
            await RlpcDecoder.open('walk.rlpc', { worker: () => new Worker('nothing.js') });""")
        self.assertEqual((error["isOurs"], error["kind"]), (True, "source"))
        self.assertIn("worker", error["message"])
        for name, words in (("nothing.wasm", "404"), ("scene.html", "sends a page")):
            error = self.error_of(f"await RlpcDecoder.open('walk.rlpc', {{ wasm: '{name}' }});")
            self.assertEqual((error["isOurs"], error["kind"]), (True, "network"))
            self.assertIn(words, error["message"])

    def test_a_limit_on_what_is_loaded_whole(self):
        self.server.ranges = False
        error = self.error_of("await RlpcDecoder.open('walk.rlpc', { maxMemory: 50000 });")
        self.assertEqual((error["isOurs"], error["kind"]), (True, "limit"))
        self.assertIn("maxMemory", error["message"])

    def test_a_limit_on_memory(self):
        error = self.error_of("""
            const bytes = await (await fetch('walk.rlpc')).arrayBuffer();
            const decoder = await RlpcDecoder.open(bytes, { maxMemory: 10000 });
            await decoder.frame(0);""")
        self.assertEqual(error["kind"], "limit")

    def test_bytes_and_blobs(self):
        hashes = self.run_script("""
            const bytes = new Uint8Array(await (await fetch('walk.rlpc')).arrayBuffer());
            const padded = new Uint8Array(bytes.length + 8);
            padded.set(bytes, 3);
            const sources = [bytes, bytes.buffer, padded.subarray(3, 3 + bytes.length),
                             new Blob([bytes])];
            return Promise.all(sources.flatMap((source) => [true, false].map(async (worker) => {
              const decoder = await RlpcDecoder.open(source, { worker });
              const frame = await decoder.frame(33);
              decoder.close();
              return sha256(frame.positions);
            })));""")
        self.assertEqual(hashes, 8 * [self.hash_of(33)])

    def test_stale_requests_are_cancelled(self):
        result = self.run_script("""
            const decoder = await RlpcDecoder.open('walk.rlpc');
            const outcomes = await Promise.allSettled(
              Array.from({ length: 50 }, (_, i) => decoder.frame(i, { replace: true })));
            const controller = new AbortController();
            const late = decoder.frame(3, { signal: controller.signal }).catch((e) => e.name);
            controller.abort();
            return {
              names: [...new Set(outcomes.slice(0, -1).map((one) => one.reason?.name))],
              last: await sha256(outcomes.at(-1).value.positions), late: await late,
            };""")
        self.assertEqual(result["names"], ["AbortError"])
        self.assertEqual(result["last"], self.hash_of(49))
        self.assertEqual(result["late"], "AbortError")
        self.assertLess(self.server.sent(), self.stream.stat().st_size / 2)

    def test_a_request_that_waits_for_the_server_is_cancelled(self):
        self.run_script("globalThis.decoder = await RlpcDecoder.open('walk.rlpc'); return null;")
        self.server.bytes_per_second = 200
        result = self.run_script("""
            const controller = new AbortController();
            const slow = decoder.frame(40, { signal: controller.signal }).catch((e) => e.name);
            setTimeout(() => controller.abort(), 200);
            const start = performance.now();
            const near = await decoder.frame(0).then((frame) => sha256(frame.positions));
            return { near, name: await slow, ms: performance.now() - start };""")
        self.assertEqual(result["name"], "AbortError")
        self.assertEqual(result["near"], self.hash_of(0))
        self.assertLess(result["ms"], 5000)

    def textured(self, name, *arguments):
        """The elephant with texture coordinates."""
        lines = pathlib.Path(f"{ELEPHANT}.obj").read_text().splitlines()
        points = [line.split()[1:3] for line in lines if line.startswith("v ")]
        source = self.folder / "textured.obj"
        source.write_text("\n".join(
            [line for line in lines if line.startswith("v ")]
            + [f"vt {x} {y}" for x, y in points]
            + ["f " + " ".join(f"{corner.split('/')[0]}/{corner.split('/')[0]}"
                               for corner in line.split()[1:])
               for line in lines if line.startswith("f ")]))
        stream = self.folder / name
        done = run("rlpcenc", "-q", source, "--points", f"{ELEPHANT}.pc2", "--preset", "fast",
                   "-o", stream, *arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        return stream

    def test_attributes_load_the_first_gof_only(self):
        stream = self.textured("textured.rlpc", "--gof", "3", "--profile", "high", "--lossless",
                               "22")
        frames = float_frames(stream, self.folder)
        self.assertGreater(stream.stat().st_size, 100_000)
        told = self.run_script("""
            globalThis.decoder = await RlpcDecoder.open('textured.rlpc');
            const { components, count } = (await decoder.attributes()).get('uv0');
            return [decoder.info.hasAttributes, components, count];""")
        self.assertEqual(told[:2], [True, 2])
        self.assertLess(self.server.sent(), stream.stat().st_size / 2)
        self.assertTrue(self.run_script("""
            const { vertices } = await decoder.drawn();
            const [drawn, whole] = await Promise.all(
              [{ drawn: true }, {}].map((options) => decoder.frame(45, options)));
            return vertices.every((vertex, i) => [0, 1, 2].every((c) =>
              drawn.positions[3 * i + c] === whole.positions[3 * vertex + c]));"""))
        self.assertEqual(self.run_script("return sha256((await decoder.frame(45)).positions);"),
                         hashlib.sha256(frames[45]).hexdigest())
        self.assertLess(self.server.sent(), stream.stat().st_size / 2)

    def test_a_coarse_mesh_has_no_attributes(self):
        self.assertEqual(self.run_script("""
            const coarse = await RlpcDecoder.open('box.rlpc', { coarseLayers: 1 });
            const { vertices, attributes } = await coarse.drawn();
            return [coarse.info.vertices === vertices.length, attributes.size,
                    (await coarse.attributes()).size];"""), [True, 0, 0])

    def test_attributes_that_could_not_be_loaded_are_asked_for_again(self):
        self.textured("again.rlpc", "--gof", "10", "--profile", "high", "--lossless", "22")
        self.run_script("globalThis.decoder = await RlpcDecoder.open('again.rlpc'); return null;")
        self.server.cut_at = 0
        self.assertEqual(self.error_of("await decoder.attributes();")["kind"], "network")
        self.server.cut_at = None
        self.assertEqual(self.run_script("return [...(await decoder.attributes()).keys()];"),
                         ["uv0"])

    def test_a_coarse_mesh_of_an_open_stream(self):
        result = self.run_script("""
            const decoder = await RlpcDecoder.open('walk.rlpc');
            const coarse = await RlpcDecoder.open(decoder, { coarseLayers: 6 });
            const [whole, part] = [await decoder.frame(25), await coarse.frame(25)];
            const same = coarse.coarseVertices.every((vertex, i) => [0, 1, 2].every((c) =>
              whole.positions[3 * vertex + c] === part.positions[3 * i + c]));
            decoder.close(); // the other stays open
            await coarse.frame(0);
            return { same, vertices: coarse.info.vertices, triangles: coarse.info.triangles,
                     layers: decoder.info.layers, most: Math.max(...coarse.indices) };""")
        self.assertTrue(result["same"])
        self.assertLess(result["vertices"], 300)
        self.assertLess(result["most"], result["vertices"])
        self.assertGreater(result["layers"], 6)

    def test_a_coarse_mesh_loads_its_layers_only(self):
        stream = self.encode("layers.rlpc", "--gof", "20", "--kg", "0.003", "--layer-groups", "5")
        sent = []
        for options in ("{ coarseLayers: 5 }", "{}"):
            self.server.requests.clear()
            self.run_script(f"""
                const decoder = await RlpcDecoder.open('layers.rlpc', {options});
                await decoder.frame(50);
                decoder.close();
                return null;""")
            sent.append(self.server.sent() - HEAD - TAIL)
        self.assertLess(sent[0], 0.5 * sent[1])
        print(f"a frame of a stream of {stream.stat().st_size} bytes, 3 GOFs without an index: "
              f"{sent[1]} bytes, its coarse mesh {sent[0]}")

    def test_what_is_no_stream(self):
        for name, start, hint in (("a.glb", b"glTF", "it looks like glTF"),
                                  ("a.html", b"<!doctype html>", "it looks like a page"),
                                  ("a.bin", b"bytes", "not an RLPC stream (rule R-STR-01)")):
            (self.folder / name).write_bytes(start + bytes(100))
            error = self.error_of(f"await RlpcDecoder.open('{name}');")
            self.assertIn(hint, error["message"])

    def test_a_damaged_stream(self):
        data = bytearray(self.stream.read_bytes())
        data[len(data) // 2] ^= 0x10
        (self.folder / "damaged.rlpc").write_bytes(data)
        result = self.run_script("""
            const decoder = await RlpcDecoder.open('damaged.rlpc');
            const errors = [];
            for (let i = 0; i < 60; ++i) {
              await decoder.frame(i).catch((error) => errors.push([i, error]));
            }
            return errors.map(([i, { kind, rule, element, bitOffset, message }]) =>
              ({ i, kind, rule, element, bitOffset, message }));""")
        self.assertEqual(len(result), 3)  # those of a GOF
        self.assertEqual(result[0]["i"] % 3, 0)
        self.assertEqual((result[0]["kind"], result[0]["rule"], result[0]["element"]),
                         ("invalid", "R-UNT-03", "unit_crc"))
        self.assertAlmostEqual(result[0]["bitOffset"] / (4 * len(data)), 1, delta=0.2)
        self.assertIn("R-UNT-03", result[0]["message"])

    def test_a_frame_that_does_not_fit_its_hash(self):
        shutil.copy(STREAMS / "v1.0" / "reject" / "HSH" / "HSH-0001x1.rlpc",
                    self.folder / "hash.rlpc")
        open_it = "const decoder = await RlpcDecoder.open('hash.rlpc');"
        error = self.error_of(open_it + "await decoder.frame(0);")
        self.assertEqual((error["kind"], error["rule"]), ("invalid", "R-HSH-02"))
        self.assertEqual(self.run_script(open_it + """
            const frame = await decoder.frame(0, { tolerant: true });
            return [frame.error.rule, frame.positions.length > 0];"""), ["R-HSH-02", True])

    def test_a_stream_that_is_cut_off(self):
        data = self.stream.read_bytes()
        (self.folder / "cut.rlpc").write_bytes(data[:len(data) // 2])
        result = self.run_script("""
            const decoder = await RlpcDecoder.open('cut.rlpc');
            const first = await sha256((await decoder.frame(0)).positions);
            const error = await decoder.frame(50).catch((error) => error);
            return { first, kind: error.kind, message: error.message };""")
        self.assertEqual((result["first"], result["kind"]), (self.hash_of(0), "truncated"))
        (self.folder / "begun.rlpc").write_bytes(data[:40])
        self.assertEqual(self.error_of("await RlpcDecoder.open('begun.rlpc');")["kind"],
                         "truncated")

    def test_a_connection_that_is_lost(self):
        for ranges in (True, False):
            self.server.ranges = ranges
            self.server.cut_at = 10_000
            error = self.error_of("""
                const decoder = await RlpcDecoder.open('walk.rlpc');
                await decoder.frame(30);""")
            self.assertEqual((error["isOurs"], error["kind"]), (True, "network"), error)

    def test_a_stream_that_changes_on_the_server(self):
        self.server.changes = True
        error = self.error_of("await RlpcDecoder.open('walk.rlpc');")
        self.assertEqual(error["kind"], "network")
        self.assertIn("changed", error["message"])

    def test_what_is_not_there_or_not_a_stream(self):
        error = self.error_of("await RlpcDecoder.open('nothing.rlpc');")
        self.assertEqual(error["kind"], "network")
        self.assertIn("404", error["message"])
        error = self.error_of("await RlpcDecoder.open('scene.html');")
        self.assertEqual((error["kind"], error["rule"]), ("invalid", "R-STR-01"))
        (self.folder / "empty.rlpc").write_bytes(b"")
        self.assertEqual(self.error_of("await RlpcDecoder.open('empty.rlpc');")["kind"],
                         "truncated")
        self.assertEqual(self.error_of("await RlpcDecoder.open(5);")["name"], "TypeError")

    def test_after_close(self):
        error = self.error_of("""
            const decoder = await RlpcDecoder.open('walk.rlpc');
            const waiting = decoder.frame(0);
            decoder.close();
            await waiting;""")
        self.assertEqual((error["isOurs"], error["kind"]), (True, "closed"))
        error = self.error_of("""
            const decoder = await RlpcDecoder.open('walk.rlpc');
            decoder.close();
            await decoder.frame(0);""")
        self.assertEqual(error["kind"], "closed")
        error = self.error_of("""
            const decoder = await RlpcDecoder.open('walk.rlpc');
            decoder.close();
            await RlpcDecoder.open(decoder);""")
        self.assertEqual(error["kind"], "closed")

    def test_frames_that_are_not_there(self):
        for frame in ("-1", "60", "1.5", "'a'"):
            error = self.error_of(f"""
                const decoder = await RlpcDecoder.open('walk.rlpc');
                await decoder.frame({frame});""")
            self.assertEqual(error["name"], "RangeError", frame)

    def test_a_download_while_frames_are_decoded(self):
        result = self.run_script("""
            const decoder = await RlpcDecoder.open('walk.rlpc');
            const blob = decoder.download();
            const hash = await sha256((await decoder.frame(50)).positions);
            return { hash, all: await sha256(await (await blob).arrayBuffer()) };""")
        self.assertEqual(result["hash"], self.hash_of(50))
        self.assertEqual(result["all"], hashlib.sha256(self.stream.read_bytes()).hexdigest())


if __name__ == "__main__":
    main()
