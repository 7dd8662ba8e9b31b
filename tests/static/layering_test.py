"""layering.py finds violations in made-up trees."""
import pathlib
import tempfile
import unittest

import layering

CMAKE = """
set(DISPERSA_LINKS_math "")
set(DISPERSA_LINKS_dynamics math)
set(DISPERSA_LINKS_flight dynamics)
set(DISPERSA_LINKS_campaign_yaml flight)
set(DISPERSA_LINKS_idl "")
set(DISPERSA_LINKS_transport idl flight)
"""


class LayeringTest(unittest.TestCase):
    def check(self, files, cmake=CMAKE):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name, text in {"CMakeLists.txt": cmake, "idl/dispersion.idl": "", **files}.items():
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).write_text(text)
            return layering.check(root)

    def test_accepts_direct_and_indirect_links_and_owners(self):
        self.assertEqual(self.check({
            "core/flight/a.cc": '#include "core/flight/a.h"\n#include "core/math/b.h"\n#include <vector>\n',
            "core/dynamics/c.cc": "#include <arkode/arkode_erkstep.h>\n#include <nvector/nvector_serial.h>\n",
            "core/campaign_yaml/d.cc": "#include <yaml-cpp/yaml.h>\n",
            "services/transport/e.cc": "#include <fastdds/dds/domain/DomainParticipant.hpp>\n"
                                       '#include "dispersionPubSubTypes.h"\n',
        }), [])

    def test_finds_an_upward_include(self):
        self.assertEqual(self.check({"core/math/a.h": '\n#include "core/flight/flight.h"\n'}),
                         ["core/math/a.h:2: math includes core/flight/flight.h but may not use flight"])

    def test_finds_a_service_used_by_the_core(self):
        self.assertEqual(self.check({"core/flight/a.cc": '#  include "services/transport/bus.h"\n'}),
                         ["core/flight/a.cc:1: flight includes services/transport/bus.h but may not use transport"])

    def test_finds_a_service_behind_the_links_of_the_engine_half(self):
        self.assertEqual(self.check({}, CMAKE + "set(DISPERSA_SERVICE_MODULES idl transport)\n"), [])
        wrong = CMAKE + "set(DISPERSA_LINKS_cli transport)\nset(DISPERSA_SERVICE_MODULES idl\n    transport)\n"
        self.assertEqual(self.check({}, wrong), [
            f"CMakeLists.txt: module cli needs {used} of the service, which a build without it lacks"
            for used in ("idl", "transport")])

    def test_finds_generated_types_outside_transport(self):
        self.assertEqual(self.check({"core/flight/a.cc": "#include <dispersion.h>\n"}),
                         ["core/flight/a.cc:1: flight includes dispersion.h but may not use idl"])

    def test_finds_third_party_headers_outside_their_owner(self):
        self.assertEqual(self.check({
            "core/flight/a.cc": "#include <fastdds/rtps/common/Guid.h>\n",
            "core/flight/b.cc": "#include <yaml-cpp/yaml.h>\n",
            "services/transport/c.h": "#include <cvode/cvode.h>\n",
        }), [
            "core/flight/a.cc:1: flight includes fastdds/rtps/common/Guid.h, which only idl and transport may",
            "core/flight/b.cc:1: flight includes yaml-cpp/yaml.h, which only campaign_yaml may",
            "services/transport/c.h:1: transport includes cvode/cvode.h, which only dynamics may",
        ])

    def test_finds_a_relative_include(self):
        self.assertEqual(self.check({"core/flight/sub/a.cc": '#include "../secret.h"\n'}),
                         ['core/flight/sub/a.cc:1: "../secret.h" is not a path from the repository root'])

    def test_finds_a_module_outside_the_table(self):
        self.assertEqual(self.check({"core/shadow/a.h": ""}),
                         ["core/shadow/a.h: module shadow has no DISPERSA_LINKS_shadow in CMakeLists.txt"])

    def test_finds_a_cycle_in_the_table(self):
        self.assertEqual(self.check({}, "set(DISPERSA_LINKS_a b)\nset(DISPERSA_LINKS_b a)\n"),
                         ["CMakeLists.txt: module a uses itself through its links",
                          "CMakeLists.txt: module b uses itself through its links"])


if __name__ == "__main__":
    unittest.main()
