"use strict";
// An axis as the chart wrote it: value to position and back.
function ChartAxis(text) {
  const [low, high, from, to, scale, percent] = text.split(" ");
  const log = scale === "log", f = log ? Math.log10 : v => v;
  const a = f(+low), b = f(+high), p = +from, q = +to;
  return {log, percent: percent === "percent",
          at: v => p + (q - p) * Math.min(1, Math.max(0, (f(v) - a) / (b - a))),
          value: x => { const u = a + (b - a) * (x - p) / (q - p); return log ? 10 ** u : u; }};
}

// A path's first point, and the sums of its steps.
function ChartPoints(path) {
  const numbers = path.match(/-?[\d.]+/g).map(Number), points = [];
  for (let i = 0, x = 0, y = 0; i < numbers.length; i += 2) points.push([x += numbers[i], y += numbers[i + 1]]);
  return points;
}

// The keyboard reaches the data of every chart: Tab to the chart, arrows from point to point and from curve to
// curve. Where the page knows cases, a point is also given to its pointer functions, so that they name the case.
(() => {
  document.body.insertAdjacentHTML("beforeend", '<div id="said" class="tip" role="status" hidden></div>');
  const said = document.getElementById("said");
  const number = (value, axis) => axis.percent ? +(100 * value).toPrecision(3) + " %" : String(+value.toPrecision(4));

  function SeriesOf(plot, labels, xs, ys) {
    const series = [], named = new Map();
    const add = (name, kind, points) => {
      const key = kind + name;
      if (!named.has(key)) { named.set(key, {name, kind, points: []}); series.push(named.get(key)); }
      named.get(key).points.push(...points);
    };
    for (const path of plot.querySelectorAll("path[data-s]")) {
      const name = path.dataset.s, d = path.getAttribute("d");
      if (path.matches(".limit, .allowed, .bound")) {
        const [x, y, x1] = d.match(/-?[\d.]+/g).map(Number), upright = x === x1;
        if (name) add(name, "limit", [{x, y, say: upright ? `${name}: ${labels[0]} ${number(xs.value(x), xs)}`
                                                          : `${name}: ${labels[1]} ${number(ys.value(y), ys)}`}]);
      } else if (d.includes("h0")) {
        let x = 0, y = 0;  // steps from dot to dot
        add(name, "dots", d.split("h0").slice(0, -1).map(step => {
          const [dx, dy] = step.match(/-?[\d.]+/g).map(Number);
          return {x: x = Math.round(10 * (x + dx)) / 10, y: y = Math.round(10 * (y + dy)) / 10};
        }));
      } else if (d.endsWith("Z")) {
        // There along the upper edge, back along the lower one.
        const points = ChartPoints(d), far = Math.max(...points.map(p => p[0]));
        const turn = points.findIndex(p => p[0] === far), back = points.slice(turn + 1);
        add(name, "band", points.slice(0, turn + 1).map(([x, y]) => {
          const at = back.reduce((best, p) => Math.abs(p[0] - x) < Math.abs(best[0] - x) ? p : best, back[0] || [x, y]);
          return {x, y, low: at[1]};
        }));
      } else {
        add(name, "line", ChartPoints(d).map(([x, y]) => ({x, y})));
      }
    }
    const bars = [...plot.querySelectorAll("rect.bar")].map(bar => {
      const b = name => +bar.getAttribute(name);
      return {x: b("x") + b("width") / 2, y: b("y"), say: bar.querySelector("title").textContent};
    });
    if (bars.length) add("bars", "bars", bars);
    for (const one of series) if (one.kind !== "line") one.points.sort((a, b) => a.x - b.x);
    return series.sort((a, b) => (a.kind === "limit") - (b.kind === "limit"));
  }

  for (const svg of document.querySelectorAll("svg.chart[data-x]")) {
    const labels = [...svg.querySelectorAll(".label")].map(label => label.textContent);
    const xs = ChartAxis(svg.dataset.x), ys = ChartAxis(svg.dataset.y), plot = svg.querySelector(".plot");
    let series = null, which = 0, at = -1;
    svg.tabIndex = 0;
    svg.setAttribute("role", "application");
    svg.setAttribute("aria-label", svg.getAttribute("aria-label") + " Arrow keys read the values.");

    const Clear = () => { said.hidden = true; plot.querySelector(".key-mark")?.remove(); };
    function Show() {
      const one = series[which], point = one.points[at];
      const values = [number(xs.value(point.x), xs), number(ys.value(point.y), ys)];
      let text = point.say || `${one.name ? one.name + ": " : ""}${labels[1]} ${values[1]} at ${labels[0]} ${values[0]}`;
      if (one.kind === "band")
        text = `${one.name}: ${labels[1]} ${number(ys.value(point.low), ys)} to ${values[1]} at ${labels[0]} ${values[0]}`;
      plot.querySelector(".key-mark")?.remove();
      plot.insertAdjacentHTML("beforeend", `<path class="hit marks key-mark" d="M${point.x} ${point.y}h0"/>`);
      const matrix = plot.querySelector(".key-mark").getScreenCTM();
      const place = new DOMPoint(point.x, point.y).matrixTransform(matrix);
      if (one.kind === "dots" || one.kind === "bars" || one.name.startsWith("case ")) {
        svg.dispatchEvent(new PointerEvent("pointermove", {clientX: place.x, clientY: place.y}));
        const tip = document.getElementById("tip");
        if (tip && !tip.hidden) { text += "\n" + tip.textContent.replace("click copies", "Enter copies"); tip.hidden = true; }
      }
      said.textContent = text;
      said.hidden = false;
      said.style.left = Math.max(6, Math.min(place.x + 12, document.documentElement.clientWidth - said.offsetWidth - 6)) + "px";
      said.style.top = Math.max(6, place.y - said.offsetHeight - 12) + "px";
      return place;
    }

    svg.addEventListener("keydown", event => {
      series = series || SeriesOf(plot, labels, xs, ys);
      const step = {ArrowRight: 1, ArrowLeft: -1, PageDown: 10, PageUp: -10, Home: -Infinity, End: Infinity}[event.key];
      const turn = {ArrowDown: 1, ArrowUp: -1}[event.key];
      if (event.key === "Escape" || !series.length) { Clear(); return; }
      if (event.key === "Enter" && at >= 0) {
        const place = Show();
        svg.dispatchEvent(new PointerEvent("pick", {clientX: place.x, clientY: place.y}));
        return;
      }
      if (step === undefined && turn === undefined) return;
      event.preventDefault();
      if (turn) {
        const x = at >= 0 ? series[which].points[at].x : -Infinity;
        if (at >= 0) which = (which + turn + series.length) % series.length;
        at = series[which].points.findIndex(point => point.x >= x);
        if (at < 0) at = series[which].points.length - 1;
      } else {
        at = Math.max(0, Math.min(series[which].points.length - 1, at + step));
      }
      Show();
    });
    svg.addEventListener("blur", Clear);
  }
})();
