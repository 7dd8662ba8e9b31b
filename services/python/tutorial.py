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
# `run` writes a result folder like `dispersa run`: here in this process (`workers=0`); without that in worker processes, and
# with `peer="HOST"` on a coordinator. The verdict is a value. What is wrong with an input is an exception, and so are missing
# cases. That 120 flights without a failure do not show 99.73 % is no failure: the verdict is `inconclusive`, and the sentence
# says how many cases it takes.

# %%
results = dispersa.run(campaign, OUT / "table3", workers=0)
print(results.verdict, results.exit_code, results.report)
for requirement in results.requirements:
    print(requirement["metric"], requirement["verdict"], "-", requirement["sentence"])

# %% [markdown]
# `cases` is a pandas table with the columns of `cases.csv`, or a NumPy array where pandas is not installed; `metrics` and
# `inputs` are NumPy arrays in any case.

# %%
peak = results.metrics["pitch_error_peak_deg"]
print("worst case:", results.case_index[numpy.argmax(peak)], "with", peak.max(), "deg")
print(results.replay(int(results.case_index[numpy.argmax(peak)]))["match"])

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
