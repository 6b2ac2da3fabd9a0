"""Checks that keep() of each machine names every field of the machine, or that the list below gives the reason why not.

A field in neither place would be missing in checkpoints: a replay from a checkpoint could then make other decisions.
Usage: check_kept.py SOURCE_FOLDER | --self-test
"""
import pathlib
import re
import sys

PLAN = "follows from the plan and the options"
SHARED = "belongs to somebody else, or is a machine that is kept by its owner"
IDLE = "is empty or at rest where idle() allows a checkpoint"
ANEW = "is written in each cycle or transfer before it is read"
SHOWN = "decides nothing: is only shown, or says when to show"

NOT_KEPT = {
    "ArrivalPrediction": {PLAN: "window_"},
    "AxisStops": {SHARED: "bus_", IDLE: "ordered_ halt_ requests_"},
    "AxisRunner": {PLAN: "period_ axis_"},
    "AxisMemories": {PLAN: "axes_", SHARED: "bus_"},
    "Beat": {PLAN: "plan_", SHARED: "status_ timing_", ANEW: "began_"},
    "BusLoop": {PLAN: "state_words_", SHARED: "port_ front_", SHOWN: "report_", IDLE: "requests_",
                ANEW: "nodes_ images_ outputs_ published_"},
    "BusMachines": {PLAN: "plan observe wire", IDLE: "events service_frames"},
    "DrivenAxis": {PLAN: "axis_ position_ velocity_ target_ velocity_offset_ torque_offset_ lowest_torque_ "
                   "highest_torque_ node_outputs_ row_ longest_wait_"},
    "FrameSender": {SHARED: "port_ beat_ status_"},
    "HomingWatch": {PLAN: "patience_"},
    "Intake": {SHARED: "port_ beat_ bus_ timing_", IDLE: "left_from_ left_end_", ANEW: "received_"},
    "LossStop": {SHARED: "bus_ stops_"},
    "BootRetries": {PLAN: "plan_"},
    "LssRunner": {IDLE: "master_ state_", ANEW: "commands_ results_ count_ results_count_ timeout_"},
    "LssService": {PLAN: "plan_", SHARED: "requests_ events_", IDLE: "searched_ request_ stopping_"},
    "MissedCycles": {SHARED: "events_ status_"},
    "Network": {PLAN: "plan_ observe_ nmt_stop_ stops_drives_ index_ emcy_ids_ answers_ dictionary_", SHARED: "events_",
                IDLE: "stopping_ boots_given_up_ broadcasts_ streams_ streaming_ awaits_ awaited_ server_ command_ awaits_axes_ axes_at_rest_ "
                      "rest_"},
    "MotionStage": {SHARED: "front_ bus_", ANEW: "inputs_ message_"},
    "NetworkStart": {PLAN: "plan_"},
    "NmtGate": {PLAN: "inhibit_"},
    "NodeGuard": {PLAN: "plan_"},
    "NodeSession": {PLAN: "plan_ managed_", SHARED: "shared_",
                    IDLE: "runner_ requests_ own_command_ loss_to_report_"},
    "NodeStatus": {ANEW: "exchanging"},
    "NodeWatch": {PLAN: "timeout_"},
    "OutputLimits": {PLAN: "plan_ limits_ notations_ places_ dependents_ judged_ longest_gap_ seconds_", SHARED: "image_ inputs_",
                     ANEW: "concerned_ concerns_any_"},
    "PdoInputs": {PLAN: "plan_ fields_ extended_ window_", SHARED: "image_ events_"},
    "PdoInputs::Row": {PLAN: "first count number length node_index every multiplexed deadline"},
    "PdoOutputs": {PLAN: "plan_ inputs_count_ fields_", SHARED: "image_ inputs_ events_",
                   ANEW: "frames_ packed_ packed_count_ fresh_commands_"},
    "PdoOutputs::Row": {ANEW: "first_fallen first_risen fallen risen"},
    "PdoRequests": {PLAN: "plan_", IDLE: "slots_ used_ waiting_ late_answer_until_ late_answers_"},
    "PortWatch": {SHARED: "events_"},
    "PreviousTransfer": {ANEW: "last_answer"},
    "RefusedOutputs": {PLAN: "outputs_"},
    "RequestTable": {IDLE: "slots_ waiting_ answered_"},
    "SdoClient": {PLAN: "channel_ block_use_ segments_", IDLE: "state_ closing_ result_ no_block_",
                  ANEW: "transfer_ timeout_ deadline_ asked_ settled_ heard_at_ trace_"},
    "Slack": {SHARED: "port_ beat_ sender_ intake_ bus_", IDLE: "stream_end_"},
    "StopControl": {SHARED: "bus_", IDLE: "halt_ sequence_"},
    "SyncCounter": {PLAN: "overflow_"},
    "SyncFollower": {PLAN: "id_ declared_ tolerance_ timeout_ reaction_ overflow_", SHARED: "events_"},
    "SyncGate": {PLAN: "tolerance_"},
    "SyncHold": {PLAN: "steps_"},
    "SyncLossReaction": {SHARED: "bus_ stops_", IDLE: "fallbacks_"},
    "TimeProducer": {PLAN: "plan_"},
    "DuplicateNodeWatch": {PLAN: "period_ sdo_request_"},
}

STATEMENTS_OF_OTHER_KINDS = re.compile(
    r"^(using|static|friend|template|typedef|enum|struct|class|union|explicit|virtual|constexpr|inline)\b")


def without_comments(text):
    return re.sub(r"//[^\n]*|/\*.*?\*/|\"(?:\\.|[^\"\\])*\"|'(?:\\.|[^'\\])'", " ", text, flags=re.S)


def end_of_block(text, begin):
    """`begin` is behind the opening brace; returns the place of the closing brace."""
    depth = 1
    for at in range(begin, len(text)):
        depth += {"{": 1, "}": -1}.get(text[at], 0)
        if depth == 0:
            return at
    return len(text)


def classes(text):
    """("Outer::Name", body) of every class and struct, also of those inside others."""
    spans = []
    for head in re.finditer(r"\b(?:class|struct)\s+(\w+)(?:\s+final)?(?:\s*:[^;{]*)?\s*\{", text):
        if re.search(r"\benum\s+$", text[:head.start()]):
            continue
        end = end_of_block(text, head.end())
        outer = [name for begin, until, name in spans if begin < head.start() < until]
        spans.append((head.end(), end, "::".join([*outer[-1:], head[1]])))
        yield spans[-1][2], text[head.end():end]


def statements(body):
    """The fields of the class itself. The content of braces is left out, and the body of a function ends a
    declaration."""
    out, depth, text = [], 0, ""
    for at, char in enumerate(body):
        if char == "{":
            depth += 1
        elif char == "}":
            depth -= 1
            if depth == 0 and not re.match(r"\s*[;,]", body[at + 1:]) and "(" in text:
                text = ""
        elif depth == 0 and char == ";":
            out.append(text)
            text = ""
        elif depth == 0:
            text += char
    return [re.sub(r"\b(public|private|protected)\s*:(?!:)", "", one).strip() for one in out]


def fields(body):
    names = []
    for statement in statements(body):
        if not statement or STATEMENTS_OF_OTHER_KINDS.match(statement) or re.search(r"\boperator\b", statement):
            continue
        plain = statement
        while re.search(r"<[^<>]*>", plain):
            plain = re.sub(r"<[^<>]*>", "", plain)
        declarators = [re.sub(r"=.*", "", one, flags=re.S) for one in plain.split(",")]
        if any("(" in one for one in declarators):
            continue
        for one in declarators:
            name = re.search(r"(\w+)\s*(?:\[[^\]]*\]\s*)*$", one)
            if name:
                names.append(name[1])
    return names


def keep_bodies(text):
    """Class name -> what its keep() does, for definitions outside of the class."""
    head = r"\bvoid\s+(\w+)(?:<[^>]*>)?::keep\(Archive& state\)\s*noexcept\s*\{"
    return {found[1]: text[found.end():end_of_block(text, found.end())] for found in re.finditer(head, text)}


def own_keep(body):
    """The body of keep() of this class, not of a class inside it. None if the class has no keep()."""
    for found in re.finditer(r"\bvoid\s+keep\(Archive& state\)\s*noexcept\s*(\{|;)", body):
        depth = body[:found.start()].count("{") - body[:found.start()].count("}")
        if depth == 0:
            return "" if found[1] == ";" else body[found.end():end_of_block(body, found.end())]
    return None


def check(texts, not_kept):
    complaints, known = [], set()
    plain = [(path, without_comments(text)) for path, text in texts]
    outside = {name: body for _, text in plain for name, body in keep_bodies(text).items()}
    for path, text in plain:
        for name, body in classes(text):
            keep = own_keep(body)
            if keep is None:
                continue
            keep = keep or outside.get(name, "")
            known.add(name)
            left_out = {field for names in not_kept.get(name, {}).values() for field in names.split()}
            own = fields(body)
            for field in own:
                kept = re.search(rf"\b{field}\b", keep) is not None
                if not kept and field not in left_out:
                    complaints.append(f"{path}: {name}::{field} is not in keep(): a checkpoint would forget it. Name it "
                                      f"there, or in NOT_KEPT of check_kept.py with the reason")
                if kept and field in left_out:
                    complaints.append(f"{path}: {name}::{field} is in keep() and in NOT_KEPT")
            complaints += [f"{path}: NOT_KEPT names {name}::{gone}, which there is not" for gone in left_out - set(own)]
    complaints += [f"NOT_KEPT names {name}, which has no keep()" for name in not_kept if name not in known]
    return complaints, known


def self_test():
    good = """
        class Guard { public: int f() const { return a_; }
          bool lost() const noexcept { return at_ == never; }
          template <class Archive> void keep(Archive& state) noexcept { state(a_, at_); for (auto& r : rows_) state(r); }
         private:
          struct Row { bool known = false; std::uint8_t count{}; std::array<int, 3> last{};
            template <class Archive> void keep(Archive& state) noexcept { state(known, count, last); } };
          static constexpr int most = 3; enum class E : char { x, y };
          Guard& operator=(const Guard&) = delete; const Plan& plan_; int a_ = 0; Time at_ = f(1, 2);  // of "it"
          std::vector<Row> rows_; };
        template <class P> class Loop { template <class Archive> void keep(Archive& state) noexcept;
          Pair<A, B> both_; bool on_{}; };
        template <class P> template <class A> void Loop<P>::keep(Archive& state) noexcept { state(both_, on_); }"""
    left_out = {"Guard": {PLAN: "plan_"}}
    cases = [(good, left_out, 0, "all is named"), (good, {}, 1, "plan_ is not named"),
             (good.replace("state(a_, at_)", "state(a_)"), left_out, 1, "at_ was taken out of keep()"),
             (good.replace("bool known = false;", "bool known = false; bool late = false;"), left_out, 1, "a new field"),
             (good.replace("bool on_{};", "bool on_{}; std::optional<Time> since_;"), left_out, 1, "a new one of Loop"),
             (good.replace("int a_ = 0;", "int a_ = 0, b_ = 1;"), left_out, 1, "a second one of a line"),
             (good, {"Guard": {PLAN: "plan_ gone_"}}, 1, "an exception that there is not"),
             (good, {"Guard": {PLAN: "plan_ a_"}}, 1, "an exception that is kept"),
             (good, left_out | {"Nobody": {PLAN: "x"}}, 1, "a class that there is not")]
    failures = 0
    for text, exceptions, expected, what in cases:
        complaints, known = check([("test.hpp", text)], exceptions)
        if len(complaints) != expected or known != {"Guard", "Guard::Row", "Loop"}:
            failures += 1
            print(f"{what}: {expected} complaints expected, got {complaints} about {known}")
    return failures


def main(argument):
    if argument == "--self-test":
        return 1 if self_test() else 0
    root = pathlib.Path(argument)
    headers = sorted(path for part in ("core", "motion", "rt") for path in (root / "master" / part).rglob("*.hpp"))
    complaints, known = check([(path.relative_to(root), path.read_text()) for path in headers], NOT_KEPT)
    if len(known) < 20:
        complaints.append(f"only {len(known)} machines with a keep() were found")
    print("\n".join(complaints) or f"{len(known)} machines keep or account for all of their fields")
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
