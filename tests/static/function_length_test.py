"""function_length.py finds long functions in made-up trees."""
import pathlib
import tempfile
import unittest

import function_length


def function(head, lines):
    """A function of that many lines, from head to brace."""
    return head + " {\n" + "  f();\n" * (lines - 2) + "}\n"


class FunctionLengthTest(unittest.TestCase):
    def check(self, files, limit=4, exempt=()):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name, text in files.items():
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).write_text(text)
            return function_length.check(root, limit, exempt)

    def names(self, text):
        return [(name, line, lines) for name, line, lines in function_length.functions(text)]

    def test_holds_the_limit(self):
        self.assertEqual(self.check({"core/a.cc": function("int A()", 4)}), [])
        self.assertEqual(self.check({"core/a.cc": function("int A()", 5)}),
                         ["core/a.cc:1: A has 5 lines, 4 are allowed"])

    def test_reads_both_folders_and_headers(self):
        self.assertEqual(self.check({"core/room/a.h": function("inline int A()", 5),
                                     "services/room/b.cc": "\n" + function("int B()", 6),
                                     "tests/c.cc": function("int C()", 7)}),
                         ["core/room/a.h:1: A has 5 lines, 4 are allowed",
                          "services/room/b.cc:2: B has 6 lines, 4 are allowed"])

    def test_counts_the_head(self):
        self.assertEqual(self.names("int A(int a,\n      int b)\n    const {\n}\n"), [("A", 1, 4)])

    def test_finds_functions_of_namespaces_and_classes(self):
        text = ("namespace a::b {\nnamespace {\nclass C : public D {\n public:\n  explicit C(int e) : e_{e}, f_(e) {\n"
                "  }\n  ~C() override {\n  }\n  int operator()(int) const {\n  }\n\n private:\n  int e_{};\n};\n}\n"
                "template <class T = int>\nbool C::operator==(const C& c) const noexcept {\n}\n}\n")
        self.assertEqual(self.names(text), [("C", 5, 2), ("~C", 7, 2), ("operator()", 9, 2), ("operator==", 16, 3)])

    def test_a_table_is_no_function(self):
        self.assertEqual(self.names("const std::vector<Row> kRows = {\n {\"a(\", 1},\n {F(2), 3},\n};\nint A() {\n}\n"),
                         [("A", 5, 2)])

    def test_a_lambda_is_part_of_its_function(self):
        self.assertEqual(self.names("void A() {\n  const auto f = [](int a) {\n    return a;\n  };\n}\n"),
                         [("A", 1, 5)])

    def test_braces_in_literals_comments_and_directives_do_not_count(self):
        self.assertEqual(self.names("void A() {\n  f('{', \"{\", R\"({)\", 1'000'000);  // {\n  /* {\n */\n}\n"
                                    "#define B() {\nvoid C() {\n}\n"), [("A", 1, 5), ("C", 7, 2)])

    def test_an_exemption_holds_for_a_name_and_for_a_folder(self):
        self.assertEqual(self.check({"core/a.cc": function("int A()", 5), "core/room/b.cc": function("int B()", 5),
                                     "core/rooms/c.cc": function("int C()", 5)},
                                    exempt=("A", "core/room")),
                         ["core/rooms/c.cc:1: C has 5 lines, 4 are allowed"])

    def test_an_exemption_that_is_not_needed_fails(self):
        self.assertEqual(self.check({"core/a.cc": function("int A()", 5), "core/room/b.cc": function("int B()", 4)},
                                    exempt=("A", "B", "core/room", "Gone")),
                         ["function_length.py: the exemption B is not needed",
                          "function_length.py: the exemption core/room is not needed",
                          "function_length.py: the exemption Gone is not needed"])

    def test_finds_a_tree_without_functions(self):
        self.assertEqual(self.check({"tests/a.cc": function("int A()", 4)}), ["no function in core and services"])


if __name__ == "__main__":
    unittest.main()
