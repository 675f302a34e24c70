"""Faults of OUT.rlpa, which the judge asks for only if it is among the outputs."""

_HIGH = {"spec": ["1.0", "1.1", "1.2"], "profiles": ["baseline", "main", "high"]}
_DECLARES = {**_HIGH, "outputs": ["rlpd", "rlpa"]}


def _is_asked(request):
    return request.output.suffix == ".rlpa"


def right_attributes(_):
    """No fault."""


def decodes_high(_):
    """No fault: the outputs do without attributes."""


decodes_high.declares = _HIGH


def one_value_is_wrong(request):
    if _is_asked(request) and request.data is not None:
        request.data = request.data[:-1] + bytes([request.data[-1] ^ 1])


def attributes_are_missing(request):
    if _is_asked(request):
        request.data = None


def attributes_where_there_are_none(request):
    if _is_asked(request) and request.code == 0 and request.data is None:
        request.data = b"RLPA"


def accepts_bad_attributes(request):
    if _is_asked(request):
        request.code, request.verdict = 0, None


def attributes_despite_a_refusal(request):
    if _is_asked(request) and request.code != 0:
        request.data = b"RLPA"


def another_rule_for_attributes(request):
    if _is_asked(request) and request.code != 0:
        request.verdict["rule"] = "R-UNT-01"


def no_rule_for_attributes(request):
    if _is_asked(request) and request.code != 0:
        request.verdict = {}


def no_verdict_for_attributes(request):
    if _is_asked(request):
        request.verdict = None


def crashes_on_attributes(request):
    if _is_asked(request):
        request.code, request.verdict, request.data = 70, None, None


for _fault in (right_attributes, one_value_is_wrong, attributes_are_missing,
               attributes_where_there_are_none, accepts_bad_attributes,
               attributes_despite_a_refusal, another_rule_for_attributes, no_rule_for_attributes,
               no_verdict_for_attributes, crashes_on_attributes):
    _fault.declares = _DECLARES
