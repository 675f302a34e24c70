// Shows values under the pointer, in every chart, and a line at the frame that a viewer shows.
"use strict";
for (const figure of document.querySelectorAll("figure[data-chart]")) {
  const chart = JSON.parse(figure.dataset.chart);
  const svg = figure.querySelector("svg");
  const colours = [...figure.querySelectorAll(".legend i")].map((i) => i.style.background);
  const width = chart.right - chart.left;
  const vertical = (name) => {
    const path = document.createElementNS(svg.namespaceURI, "path");
    path.setAttribute("class", name);
    svg.append(path);
    return path;
  };
  const now = vertical("now");
  const pointer = vertical("pointer");
  const put = (line, value) => {
    const x = chart.left + value / chart.last * width;
    line.setAttribute("d", value === null ? "" : `M${x} ${chart.top}V${chart.bottom}`);
  };
  const tip = document.createElement("div");
  tip.className = "tip";
  tip.hidden = true;
  figure.append(tip);

  // Returns [index of the values, first frame, last frame] under the pointer, or null.
  const found = (event) => {
    const box = svg.getBoundingClientRect();
    const x = (event.clientX - box.left) / box.width * svg.viewBox.baseVal.width;
    const share = (x - chart.left) / width;
    if (share < -0.02 || share > 1.02) return null;
    const place = Math.min(1, Math.max(0, share)) * chart.last;
    if (chart.bars) {
      const at = chart.bars.findIndex(([first, count]) => place < first + count);
      const index = at < 0 ? chart.bars.length - 1 : at;
      return [index, chart.bars[index][0], chart.bars[index][0] + chart.bars[index][1] - 1];
    }
    const index = Math.min(chart.values[0].length - 1, Math.round(place / chart.group));
    return [index, index * chart.group, Math.min(chart.frames, (index + 1) * chart.group) - 1];
  };
  const row = (words, colour) => {
    const div = document.createElement("div");
    if (colour) {
      const i = document.createElement("i");
      i.style.background = colour;
      div.append(i);
    }
    div.append(words);
    tip.append(div);
  };
  svg.addEventListener("pointermove", (event) => {
    const at = found(event);
    tip.hidden = !at;
    if (!at) return put(pointer, null);
    const [index, first, last] = at;
    tip.replaceChildren();
    row(first === last ? `frame ${first}` : `frames ${first} – ${last}`);
    let sum = 0;
    chart.names.forEach((name, s) => {
      const value = chart.values[s][index];
      sum += value;
      if (chart.bars && value === 0) return;
      row(`${name}: ${value === null ? "–" : Number(value.toPrecision(4))}`, colours[s]);
    });
    if (chart.bars) row(`all: ${Number(sum.toPrecision(4))}`);
    put(pointer, chart.bars ? (first + last + 1) / 2 : first);
    const box = figure.getBoundingClientRect();
    const x = event.clientX - box.left;
    tip.style.top = `${event.clientY - box.top + 14}px`;
    tip.style.left = `${x > box.width / 2 ? x - tip.offsetWidth - 14 : x + 14}px`;
  });
  svg.addEventListener("pointerleave", () => {
    tip.hidden = true;
    put(pointer, null);
  });
  svg.addEventListener("click", (event) => {
    const at = found(event);
    if (at) document.dispatchEvent(new CustomEvent("go-to-frame", { detail: at[1] }));
  });
  document.addEventListener("frame-shown", (event) => {
    put(now, chart.bars ? event.detail + 0.5 : event.detail);
  });
}
