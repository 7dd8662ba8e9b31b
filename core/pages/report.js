(() => {
  const data = JSON.parse(document.getElementById("cases").textContent);
  const rowOf = new Map(data.cases.map((index, row) => [index, row]));
  const metricOf = new Map(data.metrics.map((metric, i) => [metric.name, i]));
  // None where the folder does not hold what flies a case again.
  const command = data.replay ? index => data.replay + index : null;
  const kReach = 14;  // pixels
  let marked = null, pinned = null;

  document.body.insertAdjacentHTML("beforeend", '<div id="tip" class="tip" hidden></div>');
  const tip = document.getElementById("tip");

  const charts = [...document.querySelectorAll("svg.chart[data-x]")].map(svg => {
    const plot = svg.querySelector(".plot"), v = plot.viewBox.baseVal;
    plot.insertAdjacentHTML("beforeend", '<g class="marks"></g>');
    const box = {x: v.x, y: v.y, w: v.width, h: v.height};
    const chart = {svg, plot, box, view: {...box}, x: ChartAxis(svg.dataset.x), y: ChartAxis(svg.dataset.y),
                   marks: plot.querySelector(".marks"), mx: metricOf.get(svg.dataset.mx), my: metricOf.get(svg.dataset.my),
                   ticks: svg.querySelector(".ticks").innerHTML, labels: [...svg.querySelectorAll(".mark-label")]};
    for (const label of chart.labels) label.dataset.x0 = label.getAttribute("x");
    chart.lines = [...plot.querySelectorAll("path[data-case]")].map(path => ({
      path, index: +path.dataset.case,
      points: ChartPoints(path.getAttribute("d"))}));
    if (chart.mx !== undefined) {
      chart.px = data.values[chart.mx].map(value => value === null ? NaN : chart.x.at(value));
      chart.py = chart.my === undefined ? null : data.values[chart.my].map(value => value === null ? NaN : chart.y.at(value));
    }
    return chart;
  });

  // Where the pointer is: in the drawing, and in the plot as it is zoomed.
  function Place(chart, event) {
    const p = new DOMPoint(event.clientX, event.clientY).matrixTransform(chart.svg.getScreenCTM().inverse());
    const {box, view} = chart;
    return {x: view.x + (p.x - box.x) * view.w / box.w, y: view.y + (p.y - box.y) * view.h / box.h,
            inside: p.x >= box.x && p.x <= box.x + box.w && p.y >= box.y && p.y <= box.y + box.h};
  }

  function Nearest(chart, place) {
    if (!place.inside) return null;
    const kx = chart.box.w / chart.view.w, ky = chart.box.h / chart.view.h;
    let best = null, least = kReach;
    const offer = (index, distance) => { if (distance < least) { least = distance; best = index; } };
    if (chart.px) {
      for (let row = 0; row < chart.px.length; ++row) {
        const dx = kx * (chart.px[row] - place.x), dy = chart.py ? ky * (chart.py[row] - place.y) : 0;
        offer(data.cases[row], Math.hypot(dx, dy));
      }
    }
    for (const line of chart.lines) {
      for (let i = 1; i < line.points.length; ++i) {
        const [x0, y0] = line.points[i - 1], [x1, y1] = line.points[i];
        if (place.x < x0 || place.x > x1) continue;
        const y = x1 > x0 ? y0 + (y1 - y0) * (place.x - x0) / (x1 - x0) : y1;
        offer(line.index, ky * Math.abs(y - place.y));
      }
    }
    return best;
  }

  function Mark(index) {
    if (index === marked) return;
    marked = index;
    const row = rowOf.get(index);
    for (const chart of charts) {
      let mark = "";
      if (row !== undefined && chart.px && isFinite(chart.px[row])) {
        const x = chart.px[row];
        if (chart.py && isFinite(chart.py[row])) mark = `<path class="hit" d="M${x} ${chart.py[row]}h0"/>`;
        if (!chart.py) mark = `<path class="hit-line" d="M${x} ${chart.box.y}v${chart.box.h}"/>`;
      }
      chart.marks.innerHTML = mark;
      chart.plot.classList.toggle("dimmed", chart.lines.some(line => line.index === index));
      for (const line of chart.lines) line.path.classList.toggle("strong", line.index === index);
    }
    for (const cell of document.querySelectorAll("td [data-case]"))
      cell.closest("tr").classList.toggle("hit", +cell.dataset.case === index);
  }

  function Tell(chart, index, event, note) {
    if (index === null) { tip.hidden = true; return; }
    const row = rowOf.get(index);
    const values = [chart.mx, chart.my].filter(m => m !== undefined && row !== undefined).map(m => {
      const {title, unit} = data.metrics[m], value = data.values[m][row];
      return `${title}: ${value === null ? "–" : value} ${unit}`;
    });
    const lost = data.lost.includes(index) ? " (lost)" : "";
    tip.textContent = [`case ${index}${lost}`, ...values, note || (command ? "click copies: " + command(index) : "")]
      .filter(Boolean).join("\n");
    tip.hidden = false;
    const left = Math.min(event.clientX + 14, document.documentElement.clientWidth - tip.offsetWidth - 6);
    const below = event.clientY + 16 + tip.offsetHeight < window.innerHeight;
    tip.style.left = Math.max(6, left) + "px";
    tip.style.top = (below ? event.clientY + 16 : event.clientY - tip.offsetHeight - 10) + "px";
  }

  async function Copy(text) {
    try { await navigator.clipboard.writeText(text); return true; } catch (refused) {
      const area = document.createElement("textarea");  // browsers that give a file no clipboard
      area.value = text;
      document.body.append(area);
      area.select();
      const done = document.execCommand("copy");
      area.remove();
      return done;
    }
  }

  function Ticks(chart) {
    const {svg, box, view} = chart, group = svg.querySelector(".ticks");
    const zoomed = view.w !== box.w || view.h !== box.h;
    svg.classList.toggle("zoomed", zoomed);
    chart.plot.setAttribute("viewBox", `${view.x} ${view.y} ${view.w} ${view.h}`);
    for (const label of chart.labels) {
      const x = box.x + (label.dataset.x0 - view.x) * box.w / view.w;
      label.setAttribute("x", x);
      label.style.display = x < box.x || x > box.x + box.w - 8 ? "none" : "";
    }
    if (!zoomed) { group.innerHTML = chart.ticks; return; }
    const steps = (axis, from, to, count) => {
      let low = axis.value(from), high = axis.value(to);
      if (low > high) [low, high] = [high, low];
      const values = [];
      if (axis.log && high / low > 30) {
        for (let k = Math.ceil(Math.log10(low)); 10 ** k <= high; ++k) values.push([10 ** k, 6]);
      } else {
        const raw = (high - low) / count, power = 10 ** Math.floor(Math.log10(raw)), ratio = raw / power;
        const step = power * (ratio < 1.5 ? 1 : ratio < 3.5 ? 2 : ratio < 7.5 ? 5 : 10);
        for (let k = Math.ceil(low / step); k * step <= high; ++k) values.push([k * step, step]);
      }
      return values.map(([value, step]) => {
        const shown = axis.percent ? 100 * value : value, unit = axis.percent ? 100 * step : step;
        const text = axis.log && unit >= 6 ? String(+shown.toPrecision(2))
                     : shown.toFixed(Math.min(12, Math.max(0, Math.ceil(-Math.log10(unit) - 1e-9))));
        return [axis.at(value), (/^-0\.?0*$/.test(text) ? text.slice(1) : text) + (axis.percent ? " %" : "")];
      });
    };
    let ink = "";
    for (const [y, text] of steps(chart.y, view.y, view.y + view.h, 5)) {
      const at = box.y + (y - view.y) * box.h / view.h;
      ink += `<path class="grid" d="M${box.x} ${at}h${box.w}"/><text class="tick" text-anchor="end" x="${box.x - 3}" y="${at + 4}">${text}</text>`;
    }
    for (const [x, text] of steps(chart.x, view.x, view.x + view.w, 5)) {
      const at = box.x + (x - view.x) * box.w / view.w, bottom = box.y + box.h;
      ink += `<path class="axis" d="M${at} ${bottom}v4"/><text class="tick" text-anchor="middle" x="${at}" y="${bottom + 14}">${text}</text>`;
    }
    group.innerHTML = ink;
  }

  for (const chart of charts) {
    let drag = null, dragged = false;
    const {svg} = chart, answers = chart.px || chart.lines.length > 0;
    svg.addEventListener("pointermove", event => {
      const place = Place(chart, event);
      if (drag && event.pointerType === "mouse") {
        const x = Math.min(drag.x, place.x), y = Math.min(drag.y, place.y);
        const w = Math.abs(drag.x - place.x), h = Math.abs(drag.y - place.y);
        if (Math.max(w / chart.view.w, h / chart.view.h) > 0.02) dragged = true;
        if (dragged) {
          tip.hidden = true;
          chart.marks.innerHTML = `<rect class="zoom" x="${x}" y="${y}" width="${w}" height="${h}"/>`;
          return;
        }
      }
      if (!answers) return;
      const index = Nearest(chart, place);
      Mark(index ?? pinned);
      Tell(chart, index, event);
    });
    svg.addEventListener("pointerleave", () => { tip.hidden = true; Mark(pinned); });
    svg.addEventListener("pointerdown", event => {
      const place = Place(chart, event);
      dragged = false;
      drag = place.inside && event.button === 0 && event.pointerType === "mouse" ? place : null;
      if (drag) svg.setPointerCapture(event.pointerId);
    });
    svg.addEventListener("pointerup", event => {
      if (drag && dragged) {
        const place = Place(chart, event), {box} = chart;
        const clampX = x => Math.min(box.x + box.w, Math.max(box.x, x)), clampY = y => Math.min(box.y + box.h, Math.max(box.y, y));
        const [x0, x1] = [clampX(drag.x), clampX(place.x)].sort((a, b) => a - b);
        const [y0, y1] = [clampY(drag.y), clampY(place.y)].sort((a, b) => a - b);
        // A flat drag takes the whole height, a steep one the whole width.
        const wide = x1 - x0 > 0.02 * chart.view.w, tall = y1 - y0 > 0.05 * chart.view.h;
        chart.view = {x: wide ? x0 : chart.view.x, w: wide ? x1 - x0 : chart.view.w,
                      y: tall ? y0 : chart.view.y, h: tall ? y1 - y0 : chart.view.h};
        chart.marks.innerHTML = "";
        marked = undefined;
        Mark(pinned);
        Ticks(chart);
      }
      drag = null;
    });
    svg.addEventListener("dblclick", () => { chart.view = {...chart.box}; Ticks(chart); });
    // "pick" is the keyboard's click: a click's place is rounded to whole pixels, where another case may be nearer.
    for (const kind of ["click", "pick"]) svg.addEventListener(kind, async event => {
      if (!answers || kind === "click" && dragged) return;
      const index = Nearest(chart, Place(chart, event));
      pinned = index;
      Mark(index);
      if (index === null) { tip.hidden = true; return; }
      if (!command) { Tell(chart, index, event); return; }
      const done = await Copy(command(index));
      Tell(chart, index, event, done ? "copied: " + command(index) : command(index));
    });
  }

  for (const code of document.querySelectorAll("td code[data-case]")) {
    code.addEventListener("pointerenter", () => Mark(+code.dataset.case));
    code.addEventListener("pointerleave", () => Mark(pinned));
    code.tabIndex = 0;
    code.setAttribute("role", "button");
    code.addEventListener("keydown", event => { if (event.key === "Enter") code.click(); });
    code.addEventListener("click", async () => {
      pinned = +code.dataset.case;
      Mark(pinned);
      if (await Copy(code.textContent)) code.classList.add("copied");
    });
  }
  document.addEventListener("keydown", event => {
    if (event.key !== "Escape") return;
    pinned = null;
    tip.hidden = true;
    Mark(null);
  });

  const some = data.cases.length < data.flown ? ` Of ${data.flown} cases the ${data.cases.length} most extreme answer.` : "";
  document.querySelector("nav").insertAdjacentHTML("afterend",
    '<p class="hint soft">The pointer names the nearest case of a chart and marks it in all of them' +
    (command ? '; a click copies the command that flies it again' : '') + '. Drag to zoom, double click to return. ' +
    'By keyboard: Tab to a chart, arrow keys read its values, Enter copies.' + some +
    ' <label>Mark case <input id="find" type="number" min="0"></label></p>');
  document.getElementById("find").addEventListener("input", event => {
    pinned = event.target.value === "" ? null : +event.target.value;
    Mark(pinned);
  });
})();
