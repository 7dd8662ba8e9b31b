# %% [markdown]
# # Tutorial: dispersa from Python
#
# A campaign from the file to the verdict, in cells: each begins with `# %%`, which editors that know notebooks run one at
# a time. Start it where `campaigns/` is. Everything here is what the program `dispersa` does, to the last bit.

# %% [markdown]
# ## A campaign
#
# `load` reads a campaign file and all that it refers to. Its `id` is the hash of everything that is in it, `flight_id` of
# what decides a flight: whoever has the same `flight_id` flies the same flights.

# %%
import pathlib

import dispersa
import dispersa.plot
import matplotlib.pyplot as pyplot
import numpy

CAMPAIGNS = pathlib.Path("campaigns")
OUT = pathlib.Path("tutorial")
OUT.mkdir(exist_ok=True)

campaign = dispersa.load(CAMPAIGNS / "table3.yaml", cases=120)
print(campaign)

# %% [markdown]
# What its cases fly with is drawn without flying: one row a case, one field an input. Names carry the unit.

# %%
plan = campaign.plan()
print(plan["wind_azimuth_deg"][:3])
print("thrust of stage 1:", plan["thrust_factor_stage1"].mean(), "±", plan["thrust_factor_stage1"].std())

# %% [markdown]
# ## One flight
#
# Without a case it is the nominal flight. Inputs, metrics and the time history come with it; the history is the memory that
# the flight wrote, and a column of it a view.

# %%
nominal = campaign.fly()
case = campaign.fly(17)
print(nominal.outcome, nominal.metrics["apogee_km"], "km;", case.metrics["pitch_error_peak_deg"], "deg")
print(case.history["altitude_m"].max() / 1e3, "km")

axes = dispersa.plot.history([nominal, case], ["pitch_launch_deg", "pitch_error_deg", "deflection_pitch_deg"],
                             labels=["nominal", "case 17"])
axes[0].figure.savefig(OUT / "history.png")

# %% [markdown]
# Any input may be set. How much does the yaw error grow with a wind from the side?

# %%
for speed_m_s in (0.0, 30.0, 60.0):
    flown = campaign.fly(inputs={"wind_max_speed_m_s": speed_m_s, "wind_azimuth_deg": 90.0}, history=False)
    print(f"{speed_m_s:4.0f} m/s: {flown.metrics['yaw_error_peak_deg']:.3f} deg")

# %% [markdown]
# ## A control law of your own
#
# For a prototype a function is enough: it is called at every tick of powered flight with what the autopilot measures, and
# returns the angular acceleration that it wants, rad/s². What is to be remembered goes into `tick.memory`, which belongs to
# the flight. A law that is to fly in campaigns becomes a shared object (`campaigns/control_laws`).


# %%
def damped(tick):
    """Proportional-derivative, with a leaky integral."""
    pitch = 1
    integral = 0.9995 * tick.memory.get("integral", 0.0) + 0.01 * tick.angle_error_rad[pitch]
    tick.memory["integral"] = tick.telemetry[0] = integral
    return (tick.kp_1_s2[pitch] * (tick.angle_error_rad[pitch] + 0.3 * integral)
            + tick.kd_1_s[pitch] * tick.rate_error_rad_s[pitch])


prototype = campaign.fly(17, law=damped)
print(f"pitch error, peak: {prototype.metrics['pitch_error_peak_deg']:.3f} deg, with the campaign's law "
      f"{case.metrics['pitch_error_peak_deg']:.3f} deg")

# %% [markdown]
# It flies a campaign too, when `workers=0` says that this process alone does. The result folder names the law and does not
# hold it: its ids are those of no other law, and who wants to fly a case again needs the law.

# %%
damped_results = dispersa.run(CAMPAIGNS / "smoke.yaml", OUT / "damped", workers=0, law=damped, histories=False)
print(damped_results.verdict, damped_results.campaign.autopilot)
try:
    damped_results.replay(3)
except dispersa.BadInput as error:
    print(error)
print(damped_results.replay(3, law=damped)["match"])

# %% [markdown]
# ## Many flights
#
# `fly_many` flies cases side by side and keeps the columns that are asked for, all flights in one array.

# %%
flights = campaign.fly_many(40, columns=["time_s", "altitude_m", "latitude_deg", "longitude_deg", "pitch_error_deg"])
print(flights, flights.histories.shape)
print("largest altitude:", flights.histories[:, 1].max() / 1e3, "km")

axes = dispersa.plot.ground_track(flights)
axes.figure.savefig(OUT / "ground_track.png")

# %% [markdown]
# ## A run, and its verdict
#
# `run` writes a result folder like `dispersa run`: on worker processes; with `workers=0` in this process, and with
# `peer="HOST"` on a coordinator. `progress` is told how far it is. The verdict is a value. What is wrong with an input is an exception, and so are missing
# cases. That 120 flights without a failure do not show 99.73 % is no failure: the verdict is `inconclusive`, and the sentence
# says how many cases it takes.

# %%
def show(phase, done, total, note):
    """Called some ten times a second; here the end of each phase is enough."""
    if done == total:
        print(f"{phase}: {done} of {total} {note}")


results = dispersa.run(campaign, OUT / "table3", workers=2, progress=show)
print(results.verdict, results.exit_code, results.report)
for requirement in results.requirements:
    print(requirement["metric"], requirement["verdict"], "-", requirement["sentence"])

# %% [markdown]
# `cases` is a pandas table with the columns of `cases.csv`, or a NumPy array where pandas is not installed; `metrics` and
# `inputs` are NumPy arrays in any case.

# %%
peak = results.metrics["pitch_error_peak_deg"]
print("median:", numpy.median(peak), "deg; largest:", peak.max(), "deg")

# %% [markdown]
# `worst` names the worst cases, lost flights first. Any case can be flown again; `replay` compares it with what is stored.

# %%
worst = results.worst("pitch_error_peak_deg")[0]
again = results.campaign.fly(worst)
print("worst case:", worst, again.digest == results.digest[worst], results.replay(worst)["match"])

# %% [markdown]
# ## Plots
#
# In the style of the report: bands over time, exceedance with the requirement's limit, and what drives a metric.

# %%
dispersa.plot.bands(results, "pitch_error_deg").figure.savefig(OUT / "bands.png")
dispersa.plot.exceedance(results, "pitch_error_peak_deg").figure.savefig(OUT / "exceedance.png")
dispersa.plot.drivers(results, "pitch_error_peak_deg")[0].figure.savefig(OUT / "drivers.png")

# %% [markdown]
# ## A campaign of your own
#
# `read` gives the file as a dict, to be edited; `load`, `validate` and `run` take it in place of a file. The same content has
# the same `id`, whoever wrote it.

# %%
tree = dispersa.read(CAMPAIGNS / "table3.yaml")
tree["name"] = "stronger_wind"
tree["sampling"]["cases"] = campaign.cases
tree["dispersions"]["wind"]["max_speed_m_s"] = 80.0
stronger = dispersa.load(tree)
print(stronger.id == campaign.id, stronger.plan()["wind_max_speed_m_s"][:2])

# %% [markdown]
# Vehicle, reference and autopilot are files of their own. With `inlined=True` their contents stand in the place of their names
# and can be edited too.

# %%
stiffer = dispersa.read(CAMPAIGNS / "table3.yaml", inlined=True)
for gains in stiffer["autopilot"]["pitch"]["gains"]:
    gains["kp_1_s2"] *= 1.2
print(dispersa.load(stiffer, cases=campaign.cases).fly(worst, history=False).metrics["pitch_error_peak_deg"], "deg")

# %% [markdown]
# `validate` says everything that is wrong, as objects.

# %%
tree["dispersions"]["wind"]["max_speed_m_s"] = -1.0
for problem in dispersa.validate(tree).errors:
    print(problem.path, "|", problem.message, "|", problem.allowed)

# %% [markdown]
# ## A comparison
#
# Cases of the same seed meet the same draws of whatever was not changed, and are compared pair by pair.

# %%
comparison = dispersa.compare(results, dispersa.run(stronger, OUT / "stronger", workers=0, histories=False), out=OUT)
print(comparison["sentence"])

# %% [markdown]
# ## Margins and trajectories
#
# `margins` and `optimize` return what the commands print with `--json`.

# %%
margins = dispersa.margins(campaign)
least = min(margins["computed"], key=lambda at: at["frozen"]["phase_deg"])
print("margins met:", margins["passed"], "- least phase", least["frozen"]["phase_deg"], "deg at", least["time_s"], "s")

optimized = dispersa.optimize(CAMPAIGNS / "slv4_500km.yaml", OUT / "slv4_500km.yaml")
print("target reached:", optimized.reached, optimized["errors"])

pyplot.close("all")
