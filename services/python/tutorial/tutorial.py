# %% [markdown]
# # Tutorial: dispersa from Python
#
# With this tutorial you take a campaign from the file to the verdict. Each cell begins with `# %%`; an editor with notebook
# support runs one cell at a time. Start it in the folder that has `campaigns/`. All results have the same bits as those of
# the program `dispersa`.

# %% [markdown]
# ## A campaign
#
# `load` reads a campaign file and the files that it names. `id` is the hash of all their content. `flight_id` is the hash of
# everything that decides a flight: campaigns with the same `flight_id` have the same flights.

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
# `plan` draws the inputs of the cases without flying: one row for each case, one field for each input. The names have the
# unit.

# %%
plan = campaign.plan()
print(plan["wind_azimuth_deg"][:3])
print("thrust of stage 1:", plan["thrust_factor_stage1"].mean(), "±", plan["thrust_factor_stage1"].std())

# %% [markdown]
# ## One flight
#
# Without a case number `fly` flies the nominal flight. A flight has inputs, metrics and a time history. The history is the
# memory that the flight wrote, and a column is a view of it.

# %%
nominal = campaign.fly()
case = campaign.fly(17)
print(nominal.outcome, nominal.metrics["apogee_km"], "km;", case.metrics["pitch_error_peak_deg"], "deg")
print(case.history["altitude_m"].max() / 1e3, "km")

axes = dispersa.plot.history([nominal, case], ["pitch_launch_deg", "pitch_error_deg", "deflection_pitch_deg"],
                             labels=["nominal", "case 17"])
axes[0].figure.savefig(OUT / "history.png")

# %% [markdown]
# You may set any input. For example: how much does the yaw error grow with a wind from the side?

# %%
for speed_m_s in (0.0, 30.0, 60.0):
    flown = campaign.fly(inputs={"wind_max_speed_m_s": speed_m_s, "wind_azimuth_deg": 90.0}, history=False)
    print(f"{speed_m_s:4.0f} m/s: {flown.metrics['yaw_error_peak_deg']:.3f} deg")

# %% [markdown]
# ## A control law of your own
#
# For a prototype a function is enough. It is called at every tick of powered flight with the measurements of the autopilot,
# and returns the commanded angular acceleration, rad/s². It keeps its state in `tick.memory`, which belongs to the flight.
# If others shall fly the law, make it a shared object (`campaigns/control_laws`).


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
# The law can also fly a campaign, in this process only: `workers=0`. The result folder has the name of the law, but not the
# law. Its ids differ from those of every other law. To fly a case again you need the law.

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
# `fly_many` flies cases side by side and keeps the requested columns of all flights in one array.

# %%
flights = campaign.fly_many(40, columns=["time_s", "altitude_m", "latitude_deg", "longitude_deg", "pitch_error_deg"])
print(flights, flights.histories.shape)
print("largest altitude:", flights.histories[:, 1].max() / 1e3, "km")

axes = dispersa.plot.ground_track(flights)
axes.figure.savefig(OUT / "ground_track.png")

# %% [markdown]
# ## A run, and its verdict
#
# `run` writes a result folder like `dispersa run`: with worker processes, in this process (`workers=0`), or on a coordinator
# (`peer="HOST"`). It calls `progress` now and then. The verdict is a value. A wrong input is an exception, and so are missing
# cases. 120 flights without a failure do not show 99.73 %. So the verdict is `inconclusive`, and the sentence says how many
# cases are needed.

# %%
def show(phase, done, total, note):
    """Called about ten times a second; prints the end of each phase only."""
    if done == total:
        print(f"{phase}: {done} of {total} {note}")


results = dispersa.run(campaign, OUT / "table3", workers=2, progress=show)
print(results.verdict, results.exit_code, results.report)
for requirement in results.requirements:
    print(requirement["metric"], requirement["verdict"], "-", requirement["sentence"])

# %% [markdown]
# `cases` is a pandas table with the columns of `cases.csv`, or a NumPy array if pandas is not installed. `metrics` and
# `inputs` are always NumPy arrays.

# %%
peak = results.metrics["pitch_error_peak_deg"]
print("median:", numpy.median(peak), "deg; largest:", peak.max(), "deg")

# %% [markdown]
# `worst` gives the worst cases, lost flights first. You can fly any case again; `replay` compares it with the stored result.

# %%
worst = results.worst("pitch_error_peak_deg")[0]
again = results.campaign.fly(worst)
print("worst case:", worst, again.digest == results.digest[worst], results.replay(worst)["match"])

# %% [markdown]
# ## Plots
#
# `dispersa.plot` draws in the style of the report: bands over time, exceedance with the requirement's limit, and the inputs
# that drive a metric.

# %%
dispersa.plot.bands(results, "pitch_error_deg").figure.savefig(OUT / "bands.png")
dispersa.plot.exceedance(results, "pitch_error_peak_deg").figure.savefig(OUT / "exceedance.png")
dispersa.plot.drivers(results, "pitch_error_peak_deg")[0].figure.savefig(OUT / "drivers.png")

# %% [markdown]
# ## A campaign of your own
#
# `read` returns the file as a dict that you can edit. `load`, `validate` and `run` accept the dict in place of a file. Equal
# content has the same `id`.

# %%
tree = dispersa.read(CAMPAIGNS / "table3.yaml")
tree["name"] = "stronger_wind"
tree["sampling"]["cases"] = campaign.cases
tree["dispersions"]["wind"]["max_speed_m_s"] = 80.0
stronger = dispersa.load(tree)
print(stronger.id == campaign.id, stronger.plan()["wind_max_speed_m_s"][:2])

# %% [markdown]
# Vehicle, reference and autopilot are files of their own. With `inlined=True` their contents replace their names, so you can
# edit them too.

# %%
stiffer = dispersa.read(CAMPAIGNS / "table3.yaml", inlined=True)
for gains in stiffer["autopilot"]["pitch"]["gains"]:
    gains["kp_1_s2"] *= 1.2
print(dispersa.load(stiffer, cases=campaign.cases).fly(worst, history=False).metrics["pitch_error_peak_deg"], "deg")

# %% [markdown]
# `validate` returns every error as an object.

# %%
tree["dispersions"]["wind"]["max_speed_m_s"] = -1.0
for problem in dispersa.validate(tree).errors:
    print(problem.path, "|", problem.message, "|", problem.allowed)

# %% [markdown]
# ## A comparison
#
# With the same seed, all unchanged dispersions have the same draws. So the cases are compared pair by pair.

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
