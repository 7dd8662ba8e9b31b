"""Metrics of a campaign's own on a coordinator: campaigns of the same flights that measure different things.

Environment as of processes.py.
"""
from processes import Run, lost_text, main
from service_case import ServiceCase

OWN = {"q_burn1_max_kpa": "max(qbar_pa while burn1) / 1000", "high_q_time_s": "time(qbar_pa > 30000)"}


class OwnMetricsTest(ServiceCase):
    DOMAIN = "53"

    def flown(self, name, metrics):
        """A campaign file and its run without workers."""
        items = "".join(f"  - {{name: {key}, expression: '{OWN[key]}'}}\n" for key in metrics)
        campaign = self.root / f"{name}.yaml"
        campaign.write_text(lost_text("smoke", f"metrics:\n{items}" if metrics else ""))
        return campaign, Run(self.root / name, "--workers", 0, campaign=campaign).finish()

    def test_each_has_its_own_whatever_flew_before(self):
        self.start_coordinator()
        self.start_worker()
        flown = []
        for name, metrics in (("none", []), ("both", list(OWN)), ("one", ["high_q_time_s"]), ("turned", list(OWN)[::-1])):
            campaign, reference = self.flown(name, metrics)
            identity = self.dispersa("launch", campaign).strip()
            self.dispersa("watch", identity, code=reference.code)
            self.assert_same_folder(identity, reference)
            flown.append(identity)
        log = self.log.read_text()
        # The second lacks the first's metrics and flies; the others take over what has theirs.
        self.assertEqual(log.count("its results are not taken over: they lack metrics of the campaign smoke"), 4, log[-3000:])
        self.assertIn(f"({flown[2][:8]}) flies: 12 of 12 cases have a result", log)
        self.assertIn(f"({flown[3][:8]}) flies: 12 of 12 cases have a result", log)


if __name__ == "__main__":
    main()
