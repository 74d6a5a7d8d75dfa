// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/pictures/report_script.hpp"

#include "post/pictures/colour_map.hpp"

#include <fmt/format.h>

#include <string_view>

namespace dielast::post {

namespace {

/// Tables of more than two rows, up, then down; not by columns whose numbers have different units.
constexpr std::string_view sorting = R"js(
for (const table of document.querySelectorAll("table")) {
  const body = table.tBodies[0], rows = [...body.rows];
  if (rows.length < 3) continue;
  const units = [...table.tHead.rows[0].cells].findIndex(head => head.textContent.trim() === "Unit");
  const mixed = units >= 0 && new Set(rows.map(row => row.cells[units]?.textContent.trim())).size > 1;
  [...table.tHead.rows[0].cells].forEach((head, column) => {
    const text = row => row.cells[column] ? row.cells[column].textContent.trim() : "";
    const number = words => words.match(/^([-+]?[0-9.]+(?:e[-+]?[0-9]+)?)(.*)$/i);
    const filled = rows.map(text).filter(words => words !== "" && words !== "-");
    const numbers = filled.map(number).filter(found => found);
    const numeric = numbers.length === filled.length && new Set(numbers.map(found => found[2].trim())).size === 1;
    if (numbers.length > 0 && (!numeric || mixed)) return;
    const key = row => {
      const words = text(row);
      return words === "" || words === "-" ? null : numeric ? Number(number(words)[1]) : words;
    };
    let sign = -1;
    const sort = () => {
      sign = -sign;
      rows.sort((one, other) => {
        const a = key(one), b = key(other);
        if (a === null || b === null) return (a === null) - (b === null);
        return sign * (a < b ? -1 : a > b ? 1 : 0);
      });
      body.append(...rows);
    };
    head.classList.add("sorts");
    head.tabIndex = 0;
    head.addEventListener("click", sort);
    head.addEventListener("keydown", event => { if (event.key === "Enter") sort(); });
  });
}
)js";

constexpr std::string_view made = R"js(
const made = (name, parent, settings) => parent.appendChild(Object.assign(document.createElement(name), settings));
)js";

/// Each table as a CSV file, as it is sorted.
constexpr std::string_view csv = R"js(
for (const table of document.querySelectorAll("table")) {
  const title = table.closest("section").querySelector("h2").textContent;
  const link = made("a", table.parentElement, { className: "csv", textContent: "CSV", href: "#",
                                                download: title.toLowerCase().replace(/[^a-z0-9]+/g, "_") + ".csv" });
  link.addEventListener("click", () => {
    const quoted = cell => `"${cell.textContent.trim().replaceAll('"', '""')}"`;
    const lines = [...table.rows].map(row => [...row.cells].map(quoted).join(","));
    link.href = "data:text/csv;charset=utf-8," + encodeURIComponent(lines.join("\r\n") + "\r\n");
  });
}
)js";

constexpr std::string_view slides = R"js(
for (const figure of document.querySelectorAll("figure.slides")) {
  const pictures = [...figure.querySelectorAll("img")], last = pictures.length - 1;
  const row = made("div", figure, { className: "controls" });
  figure.insertBefore(row, figure.lastElementChild.previousElementSibling);
  const play = made("button", row, { type: "button", textContent: "Play" });
  const slider = made("input", row, { type: "range", min: 0, max: last, value: last });
  slider.setAttribute("aria-label", "state");
  const show = () => {
    pictures.forEach((picture, i) => { picture.hidden = i !== Number(slider.value); });
    figure.querySelectorAll(".mark, .reading").forEach(old => { old.hidden = true; });
  };
  slider.addEventListener("input", show);
  let timer = null;
  play.addEventListener("click", () => {
    if (timer === null) {
      play.textContent = "Stop";
      timer = setInterval(() => { slider.value = (Number(slider.value) + 1) % pictures.length; show(); }, 400);
    } else {
      play.textContent = "Play";
      clearInterval(timer);
      timer = null;
    }
  });
}
)js";

/// A plot's reading is its nearest point; a picture's the value whose colour, perhaps shaded, is nearest to
/// the pixel's.
constexpr std::string_view readings = R"js(
const short = value => String(Number(value.toPrecision(5)));
const readPlot = plot => {
  const scaled = (axis, value) => axis.log ? Math.log(value) : value;
  const along = (axis, value, from, to) => {
    const [low, high] = axis.ends.map(end => scaled(axis, end));
    return from + (scaled(axis, value) - low) / (high - low) * (to - from);
  };
  const [width, height] = plot.size, [left, right, top, bottom] = plot.frame;
  const points = [];
  for (const series of plot.series)
    series.x.forEach((x, i) => {
      if (x === null || series.y[i] === null) return;
      points.push({ x: along(plot.x, x, left, right) / width, y: along(plot.y, series.y[i], bottom, top) / height,
                    text: [series.label, plot.x.label + ": " + short(x), plot.y.label + ": " + short(series.y[i])]
                      .filter(line => line).join("\n") });
    });
  return (x, y, box) => {
    let best = null, least = 30;
    for (const point of points) {
      const away = Math.hypot((point.x - x) * box.width, (point.y - y) * box.height);
      if (away < least) { least = away; best = point; }
    }
    return best;
  };
};
const readPicture = (picture, shown) => {
  const pixels = new Map();
  const steps = 512, candidates = [];
  for (let i = 0; i <= steps; ++i) {
    const at = i / steps * (colours.length - 1), k = Math.min(Math.floor(at), colours.length - 2);
    candidates.push(colours[k].map((from, c) => from + (at - k) * (colours[k + 1][c] - from)));
  }
  return (x, y) => {
    const image = shown();
    if (!pixels.has(image)) {
      const canvas = document.createElement("canvas");
      canvas.width = image.naturalWidth;
      canvas.height = image.naturalHeight;
      const context = canvas.getContext("2d", { willReadFrequently: true });
      context.drawImage(image, 0, 0);
      pixels.set(image, context);
    }
    const pixel = [...pixels.get(image).getImageData(Math.floor(x * image.naturalWidth),
                                                     Math.floor(y * image.naturalHeight), 1, 1).data].slice(0, 3);
    let best = -1, least = 9;
    candidates.forEach((colour, i) => {
      const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
      const light = Math.min(1, Math.max(0.55, dot(pixel, colour) / dot(colour, colour)));
      const away = Math.hypot(...pixel.map((value, c) => value - light * colour[c]));
      if (away < least) { least = away; best = i; }
    });
    if (best < 0) return null;
    const value = picture.range[0] + best / steps * (picture.range[1] - picture.range[0]);
    return { x, y, text: `${picture.quantity}\n${Number(value.toPrecision(3))} ${picture.unit}` };
  };
};
for (const figure of document.querySelectorAll("figure[data-readings]")) {
  const told = JSON.parse(figure.dataset.readings), drawing = figure.querySelector(".drawing");
  const shown = () => drawing.querySelector("img:not([hidden])");
  const read = told.series ? readPlot(told) : readPicture(told, shown);
  const mark = made("div", drawing, { className: "mark", hidden: true });
  const reading = made("div", drawing, { className: "reading", hidden: true });
  drawing.addEventListener("pointermove", event => {
    const box = shown().getBoundingClientRect();
    const found = read((event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height, box);
    mark.hidden = reading.hidden = !found;
    if (!found) return;
    reading.textContent = found.text;
    for (const element of [mark, reading]) {
      element.style.left = 100 * found.x + "%";
      element.style.top = 100 * found.y + "%";
    }
    reading.classList.toggle("leftwards", found.x > 0.6);
  });
  drawing.addEventListener("pointerleave", () => { mark.hidden = reading.hidden = true; });
}
)js";

} // namespace

std::string report_script() {
  // The map is linear between these.
  constexpr int stops = 11;
  std::string colours;
  for (int i = 0; i < stops; ++i) {
    const Colour colour = viridis(i / (stops - 1.0));
    colours += fmt::format("{}[{:.1f}, {:.1f}, {:.1f}]", i > 0 ? ", " : "", 255 * colour.red,
                           255 * colour.green, 255 * colour.blue);
  }
  return fmt::format("{}{}{}{}const colours = [{}];{}", sorting, made, csv, slides, colours, readings);
}

} // namespace dielast::post
