"""Small mistakes that a source file could hold, found by exact source extents with libclang.

A candidate is a dictionary: file, line, function, kind, original and mutated text, and the edits that
plant it. An edit replaces the bytes [start, end) of the file while the mutant is switched on by
`pieces`, a list of texts and of ranges [start, end) of the same file.
"""
import bisect
import re

from clang import cindex

FLOATS = {cindex.TypeKind.DOUBLE, cindex.TypeKind.FLOAT, cindex.TypeKind.LONGDOUBLE}
INTEGERS = {cindex.TypeKind.INT, cindex.TypeKind.UINT, cindex.TypeKind.LONG, cindex.TypeKind.ULONG,
            cindex.TypeKind.LONGLONG, cindex.TypeKind.ULONGLONG, cindex.TypeKind.SHORT,
            cindex.TypeKind.USHORT}
K = cindex.CursorKind

# Among doubles `<` and `<=` are the same in practice; among integers they are one element apart.
FLOAT_OPERATORS = {"+": ["-"], "-": ["+"], "*": ["/"], "/": ["*"], "<": [">"], ">": ["<"],
                   "<=": [">="], ">=": ["<="], "==": ["!="], "!=": ["=="]}
INTEGER_OPERATORS = FLOAT_OPERATORS | {"<": ["<=", ">"], ">": [">=", "<"], "<=": ["<", ">="],
                                       ">=": [">", "<="], "/": ["*"], "%": ["/"]}
LOGIC = {"&&": ["||"], "||": ["&&"]}
ASSIGNMENTS = {"+=": "-=", "-=": "+=", "*=": "/=", "/=": "*="}
FUNCTIONS = {"sin": "cos", "cos": "sin", "sinh": "cosh", "cosh": "sinh", "min": "max", "max": "min",
             "floor": "ceil", "ceil": "floor", "log": "log1p", "exp": "expm1", "fmin": "fmax",
             "fmax": "fmin"}
DROPPED = {"sqrt", "abs", "fabs", "cbrt"}  # f(x) becomes x
SYMMETRIC = {"min", "max", "hypot", "swap", "fmin", "fmax"}
NUMBER = re.compile(rb"^(0[xX][0-9a-fA-F']+|[0-9][0-9'.eE+-]*|\.[0-9]+[eE0-9+-]*)[uUlLfFzZ]*$")
COMMENT = re.compile(rb"//[^\n]*|/\*.*?\*/", re.S)

TRUTH = "static_cast<bool>("

# A literal is as likely as an operator, though there are many more of them.
WEIGHTS = {"arithmetic": 28, "comparison": 12, "constant": 24, "order": 10, "dropped": 14,
           "function": 6, "logic": 6}


class Finder:
    def __init__(self, root, file, unit):
        self.root, self.file = root, file
        self.path = str(root / file)
        self.text = (root / file).read_bytes()
        self.lines = [0] + [m.end() for m in re.finditer(b"\n", self.text)]
        self.found = []
        self.constants = {}  # declaration of a named number -> ranges of its uses here
        self.function = ""
        for child in unit.cursor.get_children():
            if child.location.file and child.location.file.name == self.path:
                self.walk(child, inside=False)

    # -- text -----------------------------------------------------------------
    def span(self, cursor):
        return cursor.extent.start.offset, cursor.extent.end.offset

    def line(self, offset):
        return bisect.bisect_right(self.lines, offset)

    def show(self, pieces):
        if pieces[0] == TRUTH:
            pieces = pieces[1:-1]
        text = b"".join(p.encode() if isinstance(p, str) else self.text[p[0]:p[1]] for p in pieces)
        return " ".join(text.decode(errors="replace").split())

    @staticmethod
    def truth(start, end):
        """What is asked whether it is true: an optional beside a bool would make that bool one that is there."""
        return [TRUTH, (start, end), ")"]

    def add(self, kind, start, end, *mutations):
        if start >= end or b"#" in self.text[start:end]:
            return
        for pieces in mutations:
            self.found.append(dict(file=self.file, line=self.line(start), function=self.function,
                                   kind=kind, original=self.show([(start, end)]),
                                   mutated=self.show(pieces),
                                   edits=[dict(file=self.file, start=start, end=end, pieces=pieces)]))

    # -- the tree -------------------------------------------------------------
    def walk(self, cursor, inside):
        kind = cursor.kind
        if kind in (K.STATIC_ASSERT, K.ENUM_DECL, K.CXX_THROW_EXPR) or kind.is_attribute():
            return
        start, end = self.span(cursor)
        callable_ = kind in (K.FUNCTION_DECL, K.CXX_METHOD, K.CONSTRUCTOR, K.FUNCTION_TEMPLATE,
                             K.DESTRUCTOR, K.CONVERSION_FUNCTION)
        head = self.text[start:max(start, cursor.location.offset)]
        if callable_:
            if re.search(rb"\b(constexpr|consteval)\b", head):
                return
            outer, self.function = self.function, cursor.spelling
            for child in cursor.get_children():
                self.walk(child, True)
            self.function = outer
            return
        if kind == K.VAR_DECL:
            if self.named_number(cursor, head, inside) or not inside:
                return
        children = list(cursor.get_children())
        if kind == K.CASE_STMT:
            children = children[1:]
        elif kind in (K.VAR_DECL, K.FIELD_DECL) and cursor.type.kind == cindex.TypeKind.CONSTANTARRAY:
            children = [c for c in children if c.kind != K.INTEGER_LITERAL]
        if inside or kind == K.FIELD_DECL:
            self.visit(cursor, kind, start, end, children)
        for child in children:
            self.walk(child, inside or kind in (K.FIELD_DECL, K.PARM_DECL))

    def named_number(self, cursor, head, inside):
        """A constant keeps its declaration (it may be needed by the compiler): its uses are mutated."""
        number = cursor.type.get_canonical().kind in FLOATS | INTEGERS
        constant = re.search(rb"\bconstexpr\b", head)
        return bool(constant or (number and not inside and cursor.type.is_const_qualified()))

    def visit(self, cursor, kind, start, end, children):
        if kind == K.BINARY_OPERATOR and len(children) == 2:
            self.binary(start, end, children)
        elif kind == K.COMPOUND_ASSIGNMENT_OPERATOR and len(children) == 2:
            self.assignment(start, end, children)
        elif kind == K.UNARY_OPERATOR and len(children) == 1:
            self.unary(start, end, children[0])
        elif kind in (K.FLOATING_LITERAL, K.INTEGER_LITERAL):
            self.literal(kind, start, end)
        elif kind == K.DECL_REF_EXPR:
            self.use(cursor, start, end)
        elif kind == K.CALL_EXPR:
            self.call(cursor, start, end, children)
        elif kind == K.INIT_LIST_EXPR:
            self.order(children, "")

    def binary(self, start, end, children):
        (a, b), (c, d) = self.span(children[0]), self.span(children[1])
        if not (start == a < b <= c < d == end):
            return
        sign = COMMENT.sub(b"", self.text[b:c]).strip().decode(errors="replace")
        types = [x.type.get_canonical().kind for x in children]
        if sign in LOGIC:
            self.add("logic", start, end, *[[(a, b), f" {o} ", (c, d)] for o in LOGIC[sign]])
            self.add("dropped", start, end, self.truth(a, b), self.truth(c, d))
            return
        if all(t in FLOATS | INTEGERS for t in types):
            operators = FLOAT_OPERATORS if any(t in FLOATS for t in types) else INTEGER_OPERATORS
        elif all(t in (cindex.TypeKind.ENUM, cindex.TypeKind.BOOL) for t in types):
            operators = {"==": ["!="], "!=": ["=="]}
        else:
            return
        kind = "arithmetic" if sign in ("+", "-", "*", "/", "%") else "comparison"
        swaps = [[(a, b), f" {o} ", (c, d)] for o in operators.get(sign, [])]
        self.add(kind, start, end, *swaps)
        if sign in ("+", "-", "*", "/"):
            self.add("dropped", start, end, [(a, b)])
        if sign in ("+", "*"):
            self.add("dropped", start, end, [(c, d)])
        if sign in ("-", "/"):
            self.add("order", start, end, [(c, d), f" {sign} ", (a, b)])

    def assignment(self, start, end, children):
        (a, b), (c, d) = self.span(children[0]), self.span(children[1])
        sign = COMMENT.sub(b"", self.text[b:c]).strip().decode(errors="replace")
        number = all(x.type.get_canonical().kind in FLOATS | INTEGERS for x in children)
        if sign in ASSIGNMENTS and number and start == a < b <= c < d == end:
            self.add("arithmetic", start, end, [(a, b), f" {ASSIGNMENTS[sign]} ", (c, d)])
            self.add("dropped", start, end, [(a, b)])

    def unary(self, start, end, child):
        sign = self.text[start:self.span(child)[0]].strip()
        canonical = child.type.get_canonical().kind
        if sign == b"-" and canonical in FLOATS | INTEGERS:
            self.add("arithmetic", start, end, [self.span(child)])
        elif sign == b"!" and canonical == cindex.TypeKind.BOOL:
            self.add("logic", start, end, self.truth(*self.span(child)))

    def literal(self, kind, start, end):
        text = self.text[start:end]
        if not NUMBER.match(text):
            return
        if kind == K.INTEGER_LITERAL:  # an index or a count, else a number as large as others
            small = len(text) == 1
            self.add("constant", start, end, [(start, end), " + 1"] if small else ["2 * ", (start, end)])
        elif float(text.rstrip(b"fFlL").replace(b"'", b"")) == 0:
            self.add("constant", start, end, ["1.0"])
        else:
            self.add("constant", start, end, ["2 * ", (start, end)], ["1e3 * ", (start, end)])
            if not self.text[:start].rstrip().endswith(b"-"):
                self.add("constant", start, end, ["-", (start, end)])

    def use(self, cursor, start, end):
        named = cursor.referenced
        if named is None or named.kind != K.VAR_DECL or not named.location.file:
            return
        home = named.location.file.name
        if not home.startswith(str(self.root)):
            return
        if named.type.get_canonical().kind not in FLOATS | INTEGERS:
            return
        head_start = named.extent.start.offset
        with open(home, "rb") as stream:
            head = stream.read()[head_start:named.location.offset]
        at_namespace = named.semantic_parent.kind in (K.NAMESPACE, K.TRANSLATION_UNIT)
        if not (b"constexpr" in head or (at_namespace and named.type.is_const_qualified())):
            return
        if self.text[start:end].split(b"::")[-1] != named.spelling.encode():
            return
        number = "float" if named.type.get_canonical().kind in FLOATS else "integer"
        place = f"{home[len(str(self.root)) + 1:]} {named.spelling} {number}"
        self.constants.setdefault(place, []).append([start, end])

    def call(self, cursor, start, end, children):
        arguments = [a for a in cursor.get_arguments() if a is not None]
        name = cursor.spelling
        if children and arguments and children[0].kind != K.MEMBER_REF_EXPR:
            a, b = self.span(children[0])
            callee = self.text[a:b].decode(errors="replace")
            plain = re.fullmatch(r"(std::)?(\w+)", callee)
            if a == start and plain and plain[2] == name:
                if name in FUNCTIONS:
                    self.add("function", start, end, [(plain[1] or "") + FUNCTIONS[name], (b, end)])
                if name in DROPPED and len(arguments) == 1:
                    self.add("function", start, end, [self.span(arguments[0])])
        if name not in SYMMETRIC and not name.startswith("operator"):
            self.order(arguments, name)

    def order(self, arguments, name):
        opening, closing = "()" if name else "{}"
        for left, right in zip(arguments, arguments[1:]):
            (a, b), (c, d) = self.span(left), self.span(right)
            first, second = self.text[a:b], self.text[c:d]
            kinds = [x.type.get_canonical().spelling.replace("const ", "") for x in (left, right)]
            if kinds[0] != kinds[1] or first == second or not (a < b < c < d):
                continue
            if re.search(r"\*|iterator|\(lambda|\[", kinds[0]) or b"{" in first[:1] + second[:1]:
                continue
            if not first or not second or b"\"" in first + second or first.startswith(b"."):
                continue  # members by their names keep their order
            edits = [dict(file=self.file, start=a, end=b, pieces=[[c, d]]),
                     dict(file=self.file, start=c, end=d, pieces=[[a, b]])]
            self.found.append(dict(file=self.file, line=self.line(a), function=self.function,
                                   kind="order", original=self.show([name + opening, (a, d), closing]),
                                   mutated=self.show([name + opening, (c, d), ", ", (a, b), closing]),
                                   edits=edits))


def of_file(root, file, arguments):
    """The candidates of a file and the uses of named numbers in it."""
    index = cindex.Index.create()
    unit = index.parse(str(root / file), args=arguments)
    finder = Finder(root, file, unit)
    return dict(candidates=finder.found, constants=finder.constants)


def of_constants(root, uses):
    """One candidate a change of a named number: all its uses in functions follow the switch."""
    out = []
    for place in sorted(uses):
        home, name, number = place.split(" ")
        text = (root / home).read_bytes()
        declared = re.search(rb"\b" + name.encode() + rb"\s*[={]", text)
        line = text[:declared.start()].count(b"\n") + 1 if declared else 0
        for shown in ["{} + 1"] if number == "integer" else ["2 * {}", "1e3 * {}", "-{}"]:
            before, after = shown.split("{}")
            edits = [dict(file=file, start=a, end=b, pieces=[p for p in (before, [a, b], after) if p])
                     for file, ranges in sorted(uses[place].items()) for a, b in ranges]
            out.append(dict(file=home, line=line, function="", kind="constant", original=name,
                            mutated=shown.format(name), edits=edits))
    return out
