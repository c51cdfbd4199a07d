"""One-line mutations of C++ text: which lines are statements, and what each operator makes of them.

The text is read without a parser: comments and literals are blanked, braces are counted. The
operators rely on clang-format, which puts spaces around binary operators and none around the
brackets of templates and references.
"""
import collections
import hashlib
import pathlib
import random
import re

# What is mutated. The robot's and the calibration's kernels are among kernels/.
FOLDERS = ["kernels", "nodes", "graph", "schedules", "platform/sinks/can", "platform/sinks/record"]

# code: comments, literals and what is outside of functions blanked; before: the last character of
# code above the line.
Line = collections.namedtuple("Line", "path number text code before")
Mutation = collections.namedtuple("Mutation", "path number operator before after text")

NOISE = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|'
                   r"(?<![0-9a-fA-F])'(?:\\.|[^'\\\n])'|^[ \t]*#(?:[^\n]*\\\n)*[^\n]*", re.S | re.M)
# Checks by the compiler or by a debug build, and hints to the processor: no behaviour of theirs.
CHECK = re.compile(r"\b(?:static_assert|assert)\s*\([^;]*;")
NO_STATEMENT = re.compile(r"__builtin_prefetch|^\s*(?:using|typedef)\b")

SWAPPED_PAIRS = {
    "boundary": [("<", "<="), (">", ">=")],
    "equality": [("==", "!=")],
    "arithmetic": [("+", "-"), ("*", "/"), ("%", "*"), ("+=", "-="), ("*=", "/=")],
    "bits": [("<<", ">>"), ("&", "|"), ("^", "&"), ("|=", "&="), ("<<=", ">>=")],
    "logic": [("&&", "||")],
}
COMMUTATIVE = {"min", "max", "hypot", "swap"}  # with its arguments swapped each does the same


def without_noise(text):
    def blanked(found):
        return re.sub(r"[^\n]", " ", found.group())
    return CHECK.sub(blanked, NOISE.sub(blanked, text))


def inside_bodies(code):
    """For each character: whether it lies in a function's body."""
    inside = bytearray(len(code))
    scopes = []  # "outer", "body", "initializer"
    head_from = 0
    for at, character in enumerate(code):
        if scopes and scopes[-1] == "body":
            inside[at] = 1
        if character == "{":
            scopes.append(scope_of(code[head_from:at], scopes))
        elif character == "}" and scopes:
            scopes.pop()
        if character in "{};":
            head_from = at + 1
    return inside


def scope_of(head, scopes):
    if scopes and scopes[-1] in ("body", "initializer"):
        return scopes[-1]
    head = re.sub(r"\b(?:alignas|__attribute__|requires)\s*\([^()]*\)", "", head).strip()
    if re.search(r"\bnamespace\b", head) or re.search(
            r"\b(?:struct|class|union|enum)\b[^()=]*$", head):
        return "outer"
    if head.endswith("="):
        return "initializer"
    return "body" if "(" in head or not head else "initializer"


def statement_lines(root):
    """Every line with code inside a function's body, in the order of paths."""
    lines = []
    for folder in FOLDERS:
        for path in sorted((root / folder).rglob("*.[ch]pp")):
            text = path.read_text()
            code = without_noise(text)
            inside = inside_bodies(code)
            at, before = 0, "{"
            for number, line in enumerate(text.split("\n"), 1):
                whole = code[at:at + len(line)].rstrip()
                shown = "".join(c if inside[at + i] else " "
                                for i, c in enumerate(code[at:at + len(line)]))
                at += len(line) + 1
                if re.search(r"\w", shown) and not NO_STATEMENT.search(shown):
                    lines.append(Line(str(path.relative_to(root)), number, line, shown, before))
                before = whole[-1:] or before
    return lines


def replaced(line, start, end, by):
    return line.text[:start] + by + line.text[end:]


def swapped_operators(line):
    for operator, pairs in SWAPPED_PAIRS.items():
        for pair in pairs:
            for old, new in (pair, pair[::-1]):
                if (old, new) in (("*", "%"), ("&", "^")):
                    continue
                for m in re.finditer(r"(?<= )" + re.escape(old) + r"(?= |$)", line.code):
                    yield operator, replaced(line, m.start(), m.end(), new)
    for m in re.finditer(r"\+\+|--", line.code):
        yield "arithmetic", replaced(line, m.start(), m.end(),
                                     "--" if m.group() == "++" else "++")
    for m in re.finditer(r"(?:(?<=[(\[])|(?<=[=,?:] )|(?<=return ))-(?=[\w(])", line.code):
        yield "arithmetic", replaced(line, m.start(), m.end(), "")
    for m in re.finditer(r"(?<![\w)\]])!(?=[\w(*])", line.code):
        yield "logic", replaced(line, m.start(), m.end(), "")
    for m in re.finditer(r"\bstd::(min|max)(?=[(<])", line.code):
        yield "least and most", replaced(line, m.start(1), m.end(1),
                                         "max" if m.group(1) == "min" else "min")


def closing(code, start):
    """Where the bracket that opens at `start` closes, or -1 if not on this line."""
    depth = 0
    for at in range(start, len(code)):
        depth += (code[at] in "([{") - (code[at] in ")]}")
        if depth == 0:
            return at
    return -1


def negated_conditions(line):
    for m in re.finditer(r"\b(?:if|while) \(", line.code):
        start, end = m.end(), closing(line.code, m.end() - 1)
        condition = line.code[start:end]
        if end < 0 or ";" in condition or re.search(r"[^=!<>]=[^=]", condition):
            continue
        yield "condition", replaced(line, start, end, "!(" + line.text[start:end] + ")")
    # A loop's condition stands between its semicolons.
    m = re.search(r"\bfor \([^;]*; ([^;]+);", line.code)
    if m:
        yield "condition", replaced(line, m.start(1), m.end(1), "false")


def constants(line):
    for m in re.finditer(r"(?<![\w.'])(\d[\d']*)([uUlL]*)(?![\w.'])", line.code):
        value = int(m.group(1).replace("'", ""))
        for other in ([value - 1] if value > 0 else []) + [value + 1]:
            yield "constant", replaced(line, m.start(), m.end(), f"{other}{m.group(2)}")
    for m in re.finditer(r"(?<![\w.'])(\d+\.\d*(?:e-?\d+)?|\d+e-?\d+)([fF]?)(?![\w.])", line.code):
        yield "constant", replaced(line, m.start(), m.end(),
                                   f"{float(m.group(1)) + 1!r}{m.group(2)}")
    for m in re.finditer(r"\b(?:true|false)\b", line.code):
        yield "constant", replaced(line, m.start(), m.end(),
                                   "false" if m.group() == "true" else "true")


DECLARATION = re.compile(
    r"(?:const|auto|constexpr|static|struct|class|enum|template|case|default|else|do|goto)\b|"
    r"[\w:]+(?:<[^;]*>)?(?:::\w+)?[&*]* [&*]*\w+\s*(?:[=;({\[,]|$)")


def deleted_statements(line):
    code = line.code.strip()
    if not re.fullmatch(r"[^;{}]+;", code) or line.before not in ";{}):":
        return
    if not re.match(r"[\w+\-*(:]", code) or code.startswith(("return ", ": ", "- ", "+ ", "* ")):
        return
    if not DECLARATION.match(code):
        start = line.code.index(code[0])
        yield "deleted", replaced(line, start, start + len(code), ";")


def returned_constants(line):
    for m in re.finditer(r"\breturn ([^;]+);", line.code):
        if m.group(1) not in ("0", "{}", "nullptr", "false", "true", "std::nullopt", "*this",
                              "Reason::none"):  # already what {} is, or no value
            yield "returned", replaced(line, m.start(1), m.end(1), "{}")


def swapped_arguments(line):
    for m in re.finditer(r"\b(\w+)(?:<[\w:, ]*>)?\(", line.code):
        end = closing(line.code, m.end() - 1)
        if end < 0 or m.group(1) in COMMUTATIVE or m.group(1) in ("if", "for", "while", "switch"):
            continue
        parts, depth, start = [], 0, m.end()
        for at in range(m.end(), end + 1):
            depth += (line.code[at] in "([{") - (line.code[at] in ")]}")
            if at == end or (line.code[at] == "," and depth == 0):
                parts.append((start, at))
                start = at + 2
        for (a, b), (c, d) in zip(parts, parts[1:]):
            if b > a and d > c and line.text[a:b] != line.text[c:d]:
                yield "arguments", replaced(line, a, d, line.text[c:d] + ", " + line.text[a:b])


def mutations_of(line):
    found = [*swapped_operators(line), *negated_conditions(line), *constants(line),
             *deleted_statements(line), *returned_constants(line),
             *swapped_arguments(line)]
    return [Mutation(line.path, line.number, operator, line.text.strip(), text.strip(), text)
            for operator, text in found]


def drawn(root, random_seed, only=""):
    """Each line once, in an order that its own text and the random seed decide, as they do its
    mutation: a sample changes only where the code does."""
    lines = [line for line in statement_lines(root) if line.path.startswith(only)]
    if not lines:
        raise SystemExit(f"tests/mutation: no statements in {only}; expected a folder below one of "
                         + ", ".join(FOLDERS))
    alike = collections.Counter()
    ordered = []
    for line in lines:
        words = line.path, line.text.strip()
        alike[words] += 1
        key = f"{random_seed} {words[0]} {alike[words]} {words[1]}"
        ordered.append((hashlib.sha256(key.encode()).digest(), line))
    for digest, line in sorted(ordered, key=lambda pair: pair[0]):
        by_operator = collections.defaultdict(list)
        for mutation in mutations_of(line):
            by_operator[mutation.operator].append(mutation)
        if by_operator:
            generator = random.Random(digest)
            yield generator.choice(by_operator[generator.choice(sorted(by_operator))])


def write(root, mutation, overlay):
    """Writes the mutated file below `overlay`, at its path."""
    lines = (root / mutation.path).read_text().split("\n")
    lines[mutation.number - 1] = mutation.text
    to = pathlib.Path(overlay) / mutation.path
    to.parent.mkdir(parents=True, exist_ok=True)
    to.write_text("\n".join(lines))
    return to
