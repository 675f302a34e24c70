"""Goals that no stream can reach, or that none has to: patterns of ids, each with its reason.

In a pattern, * stands for any text and <0-6> for a number from 0 to 6. A waiver is an assertion: if
a stream reaches one of its goals, the waiver is wrong, and a complaint says so.
"""

import json
import re


_SPECIAL = re.compile(r"(\*|<\d+-\d+>)")


def pattern(text):
    """The regular expression of a pattern."""
    parts = []
    for part in _SPECIAL.split(text):
        if part == "*":
            parts.append(".*")
        elif _SPECIAL.fullmatch(part):
            first, last = map(int, part[1:-1].split("-"))
            parts.append("(?:" + "|".join(map(str, range(first, last + 1))) + ")")
        else:
            parts.append(re.escape(part))
    return re.compile("".join(parts) + r"\Z")


class Waivers:
    """A list of {"goal": pattern, "reason": text}."""

    def __init__(self, path):
        self.entries = []
        if path is not None and path.exists():
            self.entries = json.loads(path.read_text(encoding="utf-8"))
        for entry in self.entries:
            if set(entry) != {"goal", "reason"} or not entry["reason"].strip():
                raise ValueError(f"{path}: an entry has a goal and a reason: {entry}")
        self.path = path
        self._patterns = [pattern(e["goal"]) for e in self.entries]

    def reason(self, goal):
        """Why a goal is waived, or None."""
        for entry, regex in zip(self.entries, self._patterns):
            if regex.match(goal):
                return entry["reason"]
        return None

    def split(self, goals):
        """Unreached goals as two lists: missing, waived."""
        missing, waived = [], []
        for goal in goals:
            (missing if self.reason(goal) is None else waived).append(goal)
        return missing, waived

    def complaints(self, all_goals, reached):
        """Returns what is wrong with the waivers themselves."""
        found = []
        for entry, regex in zip(self.entries, self._patterns):
            matching = [g for g in all_goals if regex.match(g)]
            wrong = [g for g in matching if g in reached]
            if wrong:
                found.append(f"waiver {entry['goal']}: {wrong[0]} is reached; correct the pattern "
                             "and its reason")
            elif not matching:
                found.append(f"waiver {entry['goal']}: matches no goal; remove it")
        return found
