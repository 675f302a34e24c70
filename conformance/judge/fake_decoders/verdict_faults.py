"""Faults of the verdict: what the decoder says of a stream, and how."""

import zlib


def accepts_all(request):
    request.code, request.verdict = 0, None


def rejects_all(request):
    request.code, request.verdict, request.data = 1, {"rule": "R-UNT-03", "bit": 0}, None


def rejects_what_is_unsupported(request):
    request.code = min(request.code, 1)


def unsupported_to_all(request):
    request.code, request.verdict, request.data = 2, {}, None


def declares_nothing(request):
    unsupported_to_all(request)


declares_nothing.declares = {"profiles": [], "levels": []}


def declares_level_1(request):
    """Byte 1 of the sequence header, which is the first unit, is level_idc."""
    if request.stream[16] > 1:
        unsupported_to_all(request)


declares_level_1.declares = {"levels": [1]}


def says_limit(request):
    request.code, request.verdict, request.data = 3, {}, None


def another_rule(request):
    if request.code != 0:
        request.verdict["rule"] = "R-UNT-01"


def no_rule(request):
    if request.code != 0:
        request.verdict = {}


def another_frame(request):
    if request.code != 0:
        request.verdict["frame"] += 1


def no_verdict(request):
    request.verdict = None


def verdict_is_not_last(request):
    if request.code != 0:
        request.last_words = "bye"


def verdict_has_another_name(request):
    if request.code != 0:
        request.verdict, request.last_words = None, 'rlpc_verdict {"rule":"R-UNT-03"}'


def verdict_is_no_json(request):
    if request.code != 0:
        request.verdict, request.last_words = None, "rlpc-verdict rule=R-UNT-03"


def rejects_what_either_may(request):
    """No fault: the metadata is not JSON, which decoding does not check (R-MET-03)."""
    if zlib.compress(b"no JSON") in request.stream:
        request.code, request.verdict, request.data = 1, {"rule": "R-MET-03"}, None
