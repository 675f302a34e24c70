#!/usr/bin/env python3
"""Clips, time and seeks of the mesh that RLPCLoader makes, in Chromium.

  playback_browser_test.py --bin FOLDER

Exit code: 0 passed, 1 failed, 77 if all was skipped.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "testing"))
from in_scene import InScene
from player_testing import main


class Playback(InScene):
    """The frames that a playing mesh shows."""

    def play(self, script, until="false", ticks=400):
        """The frames that are shown, with a picture each 1/30 s."""
        return self.run_script(f"""
            const mesh = await show('walk.rlpc');
            const shown = [];
            let finished = 0;
            mesh.addEventListener('frame', ({{ index }}) => shown.push(index));
            mesh.addEventListener('finished', () => ++finished);
            {script}
            for (let i = 0; i < {ticks} && !({until}); ++i) {{
              mesh.update(1 / 30);
              await new Promise((next) => setTimeout(next, 2));
            }}
            return {{ shown, finished, playing: mesh.playing, time: mesh.time,
                      duration: mesh.duration, clip: mesh.clip?.name ?? null }};""")

    def test_a_clip_is_repeated(self):
        result = self.play("mesh.play('Walk');", "shown.length >= 30")
        # Frames 4 to 15 take 11 intervals: a picture at the end of a turn is its start again.
        # Only one just before it has the last frame.
        self.assertEqual([f for f in result["shown"] if f != 15][:24],
                         [*range(4, 15), *range(4, 15), 4, 5])
        self.assertEqual(result["clip"], "Walk")
        self.assertAlmostEqual(result["duration"], 11 / 30)

    def test_a_clip_of_several_with_its_name(self):
        shown = self.run_script("""
            const mesh = await show('walk.rlpc');
            const [first, second] = mesh.clips;
            Object.assign(second, { name: first.name });
            const frames = [];
            for (const wanted of [second.name, first, second]) {
              mesh.play(wanted).pause();
              while (!mesh.update(0)) await new Promise((next) => setTimeout(next, 5));
              frames.push(mesh.frame, mesh.clip === second);
            }
            return frames;""")
        self.assertEqual(shown, [4, False, 4, False, 20, True])

    def test_a_clip_is_played_once(self):
        result = self.play("mesh.loop = THREE.LoopOnce; mesh.play('Walk');", "finished")
        self.assertEqual(result["shown"], [*range(4, 16)])
        self.assertEqual((result["finished"], result["playing"]), (1, False))

    def test_a_clip_to_and_fro(self):
        result = self.play("mesh.loop = THREE.LoopPingPong; mesh.play('Walk');",
                           "shown.length >= 26")
        self.assertEqual(result["shown"][:24], [*range(4, 16), *range(14, 3, -1), 5])

    def test_backwards(self):
        result = self.play("mesh.speed = -1; mesh.play('Walk');", "shown.length >= 16")
        self.assertEqual([f for f in result["shown"] if f != 4][:14],
                         [*range(15, 4, -1), 15, 14, 13])

    def test_pause_stop_and_time(self):
        result = self.run_script("""
            const mesh = await show('walk.rlpc');
            const settle = async () => {
              for (let i = 0; i < 40; ++i) {
                mesh.update(0.03);
                await new Promise((next) => setTimeout(next, 5));
              }
              return mesh.frame;
            };
            mesh.play('Wave "again"').pause();
            mesh.time = 0.5;
            const frames = [await settle()];
            mesh.stop();
            frames.push(await settle());
            mesh.play(null).pause();
            frames.push(await settle());
            return frames;""")
        self.assertEqual(result, [35, 20, 0])

    def test_a_clip_that_is_not_there(self):
        error = self.error_of("(await show('walk.rlpc')).play('Run');")
        self.assertEqual(error["name"], "RangeError")
        self.assertIn('"Walk", "Wave "again""', error["message"])

    def test_a_seek_that_waits_for_its_frame(self):
        self.assertEqual(self.run_script("""
            const mesh = await show('walk.rlpc');
            const shown = [];
            for (const seconds of [1, 0.5, 0.5, 0]) {
              await mesh.seek(seconds);
              shown.push(mesh.frame);
            }
            await Promise.all([mesh.seek(0.2), mesh.seek(0.3)]);
            shown.push(mesh.frame);
            const late = mesh.seek(1.2).then(() => 'shown', (error) => error.name);
            mesh.dispose();
            return [...shown, await late];"""), [30, 15, 15, 0, 9, "AbortError"])


if __name__ == "__main__":
    main()
