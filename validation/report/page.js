// The page's behaviour. Without it everything stays readable: pictures at one exposure, tables in place of charts.
(function () {
'use strict';

const report = JSON.parse(document.getElementById('report').textContent);
const one = (root, selector) => root.querySelector(selector);
const all = (root, selector) => Array.from(root.querySelectorAll(selector));
const clamp = (value, low, high) => Math.min(Math.max(value, low), high);

// Four significant digits; -1.234e-5 with a proper minus is left to print: what is read here gets copied.
function format(value) {
  if (Number.isNaN(value)) return 'NaN';
  if (!Number.isFinite(value)) return value > 0 ? 'inf' : '-inf';
  if (value === 0) return '0';
  const magnitude = Math.abs(value);
  return magnitude < 1e-4 || magnitude >= 1e6 ? value.toExponential(3) : String(Number(value.toPrecision(4)));
}

// ---------------------------------------------------------------- radiance
// The codes of pixels.hpp: sign, then 512 steps a stop around 2^0 = 16384; 0 is zero, 32766 infinite, 32767 NaN.
function valueOfCode(code) {
  const magnitude = code & 0x7FFF;
  if (magnitude === 32767) return NaN;
  const value = magnitude === 0 ? 0 : magnitude === 32766 ? Infinity : 2 ** ((magnitude - 16384) / 512);
  return code & 0x8000 ? -value : value;
}

const bytesOf = (base64) => Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));

async function inflate(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// The chunks this page needs of an 8-bit RGB PNG. Not decoded through a canvas: colour management and privacy
// settings may change what a canvas gives back.
function pngChunks(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const data = [];
  for (let at = 8; at < bytes.length; at += view.getUint32(at) + 12) {
    if (view.getUint32(at + 4) === 0x49444154) data.push(bytes.subarray(at + 8, at + 8 + view.getUint32(at)));
  }
  if (view.getUint32(24) !== 0x08020000 || bytes[28] !== 0) throw new Error('not a plain 8-bit RGB PNG');
  return { width: view.getUint32(16), height: view.getUint32(20), data: new Blob(data) };
}

function paeth(left, above, corner) {
  const guess = left + above - corner;
  const toLeft = Math.abs(guess - left), toAbove = Math.abs(guess - above), toCorner = Math.abs(guess - corner);
  return toLeft <= toAbove && toLeft <= toCorner ? left : toAbove <= toCorner ? above : corner;
}

// PNG's row filters undone: raw rows start with their filter's number.
function unfilter(raw, width, height) {
  const stride = 3 * width;
  const out = new Uint8Array(stride * height);
  for (let y = 0; y < height; ++y) {
    const filter = raw[y * (stride + 1)];
    const from = y * (stride + 1) + 1, to = y * stride;
    for (let i = 0; i < stride; ++i) {
      const left = i >= 3 ? out[to + i - 3] : 0;
      const above = y > 0 ? out[to + i - stride] : 0;
      const corner = i >= 3 && y > 0 ? out[to + i - stride - 3] : 0;
      const guess = filter === 0 ? 0 : filter === 1 ? left : filter === 2 ? above
        : filter === 3 ? (left + above) >> 1 : paeth(left, above, corner);
      out[to + i] = raw[from + i] + guess;
    }
  }
  return out;
}

// Radiance codes, 3 a pixel, from the picture that pack_radiance() makes.
async function decodeRadiance(base64) {
  const png = pngChunks(bytesOf(base64));
  const bytes = unfilter(await inflate(await png.data.arrayBuffer()), png.width, png.height);
  const half = bytes.length / 2;
  const codes = new Uint16Array(half);
  for (let i = 0; i < half; i += 3) {
    const plane = (c) => (bytes[i + c] << 8) | bytes[half + i + c];
    codes[i] = plane(0);
    codes[i + 1] = plane(1) + codes[i] - 128;
    codes[i + 2] = plane(2) + codes[i] - 128;
  }
  return { width: png.width, height: png.height / 2, codes };
}

// 8-bit sRGB of every code at an exposure: a table, so that moving the exposure costs one look-up a component.
function toneTable(stops) {
  const table = new Uint8ClampedArray(65536);
  for (let code = 1; code < 32766; ++code) {
    const linear = clamp(valueOfCode(code) * 2 ** stops, 0, 1);
    table[code] = Math.round(255 * (linear <= 0.0031308 ? 12.92 * linear : 1.055 * linear ** (1 / 2.4) - 0.055));
  }
  return table;
}

const isBroken = (code) => (code & 0x7FFF) >= 32766;

function paint(canvas, radiance, table) {
  const context = canvas.getContext('2d');
  const target = context.createImageData(radiance.width, radiance.height);
  const codes = radiance.codes;
  for (let i = 0, o = 0; i < codes.length; i += 3, o += 4) {
    const broken = isBroken(codes[i]) || isBroken(codes[i + 1]) || isBroken(codes[i + 2]);  // magenta
    target.data[o] = broken ? 255 : table[codes[i]];
    target.data[o + 1] = broken ? 0 : table[codes[i + 1]];
    target.data[o + 2] = broken ? 255 : table[codes[i + 2]];
    target.data[o + 3] = 255;
  }
  context.putImageData(target, 0, 0);
}

// Stops that bring the 95th percentile of the brightest component to 0.8.
function autoExposure(layers) {
  const values = [];
  for (const layer of layers) {
    const codes = layer.radiance.codes;
    const step = 3 * Math.max(1, Math.floor(codes.length / 3 / 20000));
    for (let i = 0; i < codes.length; i += step) {
      const value = Math.max(valueOfCode(codes[i]), valueOfCode(codes[i + 1]), valueOfCode(codes[i + 2]));
      if (value > 0 && Number.isFinite(value)) values.push(value);
    }
  }
  if (values.length === 0) return 0;
  values.sort((a, b) => a - b);
  return Math.round(4 * Math.log2(0.8 / values[Math.floor(0.95 * (values.length - 1))])) / 4;
}

// ---------------------------------------------------------------- galleries
// A layer is one picture: its box, the canvas it is shown on, its size, and its radiance where it has one.
async function makeLayer(box) {
  const image = one(box, 'img');
  const layer = { box, label: box.dataset.label, frame: one(box, '.picture'), radiance: null,
                  canvas: document.createElement('canvas') };
  if (box.dataset.radiance) layer.radiance = await decodeRadiance(box.dataset.radiance);
  else await image.decode();
  layer.canvas.width = layer.radiance ? layer.radiance.width : image.naturalWidth;
  layer.canvas.height = layer.radiance ? layer.radiance.height : image.naturalHeight;
  if (!layer.radiance) { layer.canvas.getContext('2d').drawImage(image, 0, 0); return layer; }
  layer.canvas.setAttribute('role', 'img');
  layer.canvas.setAttribute('aria-label', image.alt);
  paint(layer.canvas, layer.radiance, toneTable(0));
  image.replaceWith(layer.canvas);
  return layer;
}

function setUpExposure(gallery, layers, redraw) {
  const hdr = layers.filter((layer) => layer.radiance);
  if (hdr.length === 0) return;
  const controls = one(gallery, '.exposure'), slider = one(controls, 'input'), output = one(controls, 'output');
  const apply = () => {
    const stops = Number(slider.value);
    output.textContent = `${stops > 0 ? '+' : ''}${stops} stops (× ${format(2 ** stops)})`;
    const table = toneTable(stops);
    for (const layer of hdr) paint(layer.canvas, layer.radiance, table);
    redraw();
  };
  slider.addEventListener('input', apply);
  const setTo = (stops) => { slider.value = stops; apply(); };
  one(controls, '[data-auto]').addEventListener('click', () => setTo(autoExposure(hdr)));
  one(controls, '[data-reset]').addEventListener('click', () => setTo(slider.defaultValue));
  controls.hidden = false;
  apply();
}

function pixelAt(event, element, width, height) {
  const frame = element.getBoundingClientRect();
  const x = Math.floor((event.clientX - frame.left) / frame.width * width);
  const y = Math.floor((event.clientY - frame.top) / frame.height * height);
  return { x: clamp(x, 0, width - 1), y: clamp(y, 0, height - 1) };
}

// Under the pictures: the linear values of every picture at the pixel under the pointer.
function setUpReadout(gallery, layers) {
  const hdr = layers.filter((layer) => layer.radiance);
  if (hdr.length === 0) return () => {};
  const readout = one(gallery, '.readout'), where = one(readout, '.where');
  const cells = hdr.map((layer) => {
    const cell = document.createElement('span'), name = document.createElement('b'), numbers = document.createElement('code');
    name.textContent = layer.label;
    numbers.textContent = ' –';
    cell.append(name, ' ', numbers);
    one(readout, '.values').append(cell);
    return numbers;
  });
  readout.hidden = false;
  return (pixel, source) => {
    where.textContent = `pixel x ${pixel.x}, y ${pixel.y} (from the top left), linear R G B`;
    hdr.forEach((layer, i) => {
      const { width, height, codes } = layer.radiance;
      const fits = width === source.canvas.width && height === source.canvas.height;
      const first = 3 * (pixel.y * width + pixel.x);
      cells[i].textContent = !fits ? 'other size'
        : Array.from(codes.subarray(first, first + 3), (code) => format(valueOfCode(code)).padEnd(9)).join(' ');
    });
    for (const layer of layers) moveCross(layer, pixel);
  };
}

function moveCross(layer, pixel) {
  let cross = one(layer.frame, '.cross');
  if (!cross) {
    cross = document.createElement('div');
    cross.className = 'cross';
    layer.frame.append(cross);
  }
  cross.style.left = `${100 * (pixel.x + 0.5) / layer.canvas.width}%`;
  cross.style.top = `${100 * (pixel.y + 0.5) / layer.canvas.height}%`;
}

const kWidestBlockyStage = 384;  // the stage is about 768 wide: at twice the size pixels may show as squares

// Two chosen pictures on one stage, the left one cut at the divider.
function setUpCompare(gallery, layers, point) {
  if (layers.length < 2) return () => {};
  const compare = one(gallery, '.compare'), stage = one(compare, '.stage'), split = one(compare, '.split');
  const sides = ['left', 'right'].map((side, preset) => {
    const select = one(compare, `select[data-side="${side}"]`);
    layers.forEach((layer, i) => select.add(new Option(layer.label, i, i === preset, i === preset)));
    return { select, canvas: one(stage, `canvas[data-side="${side}"]`) };
  });
  const chosen = (side) => layers[Number(side.select.value)];
  const redraw = () => {
    for (const side of sides) {
      const source = chosen(side).canvas;
      side.canvas.width = source.width;
      side.canvas.height = source.height;
      side.canvas.getContext('2d').drawImage(source, 0, 0);
    }
    stage.setAttribute('aria-label', `${chosen(sides[0]).label} left, ${chosen(sides[1]).label} right of the divider`);
  };
  const divide = () => {
    sides[0].canvas.style.clipPath = `inset(0 ${100 - split.value}% 0 0)`;
    one(stage, '.divider').style.left = `${split.value}%`;
  };
  const follow = (event) => {
    const frame = stage.getBoundingClientRect();
    split.value = clamp(100 * (event.clientX - frame.left) / frame.width, 0, 100);
    divide();
  };
  for (const side of sides) side.select.addEventListener('change', redraw);
  split.addEventListener('input', divide);
  stage.addEventListener('pointerdown', (event) => { stage.setPointerCapture(event.pointerId); follow(event); });
  stage.addEventListener('pointermove', (event) => {
    if (event.buttons & 1) follow(event);
    const source = chosen(sides[1]);
    point(pixelAt(event, stage, source.canvas.width, source.canvas.height), source);
  });
  stage.setAttribute('role', 'img');
  stage.classList.toggle('blocky', layers[0].canvas.width <= kWidestBlockyStage);
  compare.hidden = false;
  divide();
  redraw();
  return redraw;
}

async function setUpGallery(gallery) {
  const layers = await Promise.all(all(gallery, '.picture-box').filter((box) => one(box, 'img')).map(makeLayer));
  const point = setUpReadout(gallery, layers);
  for (const layer of layers) {
    layer.frame.addEventListener('pointermove', (event) => {
      point(pixelAt(event, layer.frame, layer.canvas.width, layer.canvas.height), layer);
    });
  }
  setUpExposure(gallery, layers, setUpCompare(gallery, layers, point));
}

function setUpGalleries() {
  for (const gallery of all(document, '.gallery')) {
    setUpGallery(gallery).catch((error) => {
      const note = document.createElement('p');
      note.className = 'note';
      note.textContent = `This browser shows the pictures at one exposure only (${error.message}).`;
      one(gallery, '.pictures').before(note);
    });
  }
}

// ---------------------------------------------------------------- charts
const kInk = {
  light: { text: '#1b1f24', muted: '#59626d', grid: '#e6e9ed',
           series: ['#0072b2', '#d55e00', '#009e73', '#b5588f', '#b58100', '#3a9bd6', '#59626d'] },
  dark: { text: '#e5e8eb', muted: '#9ba5b0', grid: '#2d343b',
          series: ['#56b4e9', '#f08a4b', '#2fbf95', '#e29bc4', '#f2b84b', '#9fc9ee', '#9ba5b0'] },
};
const kMarkers = ['circle', 'rectRot', 'triangle', 'rect', 'crossRot', 'star', 'rectRounded'];
const kMostWhiskers = 30;  // more points than this: a band

const superscript = (n) => String(n).replace(/[-0-9]/g, (c) => '⁻⁰¹²³⁴⁵⁶⁷⁸⁹'['-0123456789'.indexOf(c)]);

// Plain where short, else with a power of ten, which a logarithmic axis turns to sooner.
function tickLabel(value, largestPlain) {
  if (value === 0) return '0';
  const exponent = Math.floor(Math.log10(Math.abs(value)) + 1e-9);
  if (exponent > -4 && exponent <= largestPlain) return String(Number(value.toPrecision(6)));
  const mantissa = Number((value / 10 ** exponent).toPrecision(3));
  return (mantissa === 1 ? '' : `${mantissa}·`) + `10${superscript(exponent)}`;
}

// About 3 to 9 round numbers between the ends of a logarithmic axis.
function logTicks(low, high) {
  const decades = Math.log10(high / low);
  const mantissas = decades > 3 ? [1] : decades > 1.2 ? [1, 2, 5] : decades > 0.5 ? [1, 1.5, 2, 3, 5, 7] : [1, 1.2, 1.5, 1.8, 2, 2.5, 3, 4, 5, 6, 7, 8, 9];
  const step = Math.max(1, Math.ceil(decades / 8));
  const ticks = [];
  for (let power = Math.floor(Math.log10(low)); power <= Math.ceil(Math.log10(high)); ++power) {
    if (power % step !== 0) continue;
    for (const mantissa of mantissas) {
      const value = mantissa * 10 ** power;
      if (value >= low && value <= high) ticks.push({ value });
    }
  }
  return ticks;
}

const canDraw = (value, isLog) => Number.isFinite(value) && (!isLog || value > 0);

// Points as Chart.js wants them; what an axis cannot show becomes a gap and is counted.
function pointsOf(series, chart) {
  const points = series.x.map((x, i) => ({ x: Number(x), y: Number(series.y[i]),
                                           low: Number(series.y_low[i]), high: Number(series.y_high[i]) }));
  const placed = points.filter((p) => canDraw(p.x, chart.is_x_log));
  for (const p of placed) if (!canDraw(p.y, chart.is_y_log)) p.y = NaN;
  const omitted = points.length - placed.filter((p) => Number.isFinite(p.y)).length;
  return { points: placed, omitted };
}

// Ends of an axis: the data, intervals included, and a little air; a linear height starts from 0 where the data
// come near it.
function range(values, isLog, isHeight) {
  const low = Math.min(...values), high = Math.max(...values);
  if (isLog) return { min: low / Math.max(1.12, (high / low) ** 0.05), max: high * Math.max(1.12, (high / low) ** 0.05) };
  const air = 0.06 * (high - low) || Math.abs(high) * 0.1 || 1;
  return { min: isHeight && low >= 0 && low < 0.4 * high ? 0 : low - air,
           max: isHeight && high <= 0 && high > 0.4 * low ? 0 : high + air };
}

function axis(label, isLog, values, isHeight, ink) {
  return {
    type: isLog ? 'logarithmic' : 'linear', ...range(values, isLog, isHeight),
    title: { display: true, text: label, color: ink.muted, font: { size: 12 } },
    grid: { color: ink.grid, borderColor: ink.muted, tickColor: ink.grid },
    ticks: { color: ink.muted, callback: (value) => tickLabel(value, isLog ? 3 : 5), maxRotation: 0, autoSkipPadding: 12, includeBounds: false },
    afterBuildTicks: isLog ? (scale) => { scale.ticks = logTicks(scale.min, scale.max); } : undefined,
  };
}

// Chart.js has no error bars: whiskers for few points, a band for many.
const intervals = {
  id: 'intervals',
  beforeDatasetsDraw(chart) {
    const context = chart.ctx, area = chart.chartArea, { x, y } = chart.scales;
    context.save();
    context.beginPath();
    context.rect(area.left, area.top, area.width, area.height);
    context.clip();
    chart.data.datasets.forEach((set, index) => {
      if (!chart.isDatasetVisible(index)) return;
      const bars = set.data.filter((p) => Number.isFinite(p.y) && Number.isFinite(p.low) && Number.isFinite(p.high))
        .map((p) => ({ x: x.getPixelForValue(p.x), low: y.getPixelForValue(Math.max(p.low, y.min)),
                       high: y.getPixelForValue(Math.min(p.high, y.max)) }));
      (bars.length > kMostWhiskers ? drawBand : drawWhiskers)(context, bars, set.borderColor);
    });
    context.restore();
  },
};

function drawBand(context, bars, colour) {
  context.globalAlpha = 0.2;
  context.fillStyle = colour;
  context.beginPath();
  for (const bar of bars) context.lineTo(bar.x, bar.high);
  for (const bar of bars.slice().reverse()) context.lineTo(bar.x, bar.low);
  context.fill();
  context.globalAlpha = 1;
}

function drawWhiskers(context, bars, colour) {
  context.strokeStyle = colour;
  context.lineWidth = 1.5;
  context.beginPath();
  for (const bar of bars) {
    context.moveTo(bar.x, bar.low);
    context.lineTo(bar.x, bar.high);
    for (const end of [bar.low, bar.high]) { context.moveTo(bar.x - 4, end); context.lineTo(bar.x + 4, end); }
  }
  context.stroke();
}

// The legend's sign of a reference curve.
function dashes(colour) {
  const sign = document.createElement('canvas');
  sign.width = 15;
  sign.height = 3;
  const context = sign.getContext('2d');
  context.fillStyle = colour;
  for (const x of [0, 6, 12]) context.fillRect(x, 0, x < 12 ? 4 : 3, 2);
  return sign;
}

function datasetOf(series, points, index, ink) {
  const colour = series.is_reference ? ink.muted : ink.series[index % ink.series.length];
  const isDense = points.length > kMostWhiskers;
  return {
    label: series.name, data: points, borderColor: colour, backgroundColor: colour, borderWidth: series.is_reference ? 1.5 : 2,
    borderDash: series.is_reference ? [6, 4] : [], pointRadius: series.is_reference || isDense ? 0 : 4, pointHoverRadius: 5,
    pointStyle: series.is_reference ? dashes(colour) : kMarkers[index % kMarkers.length], pointBorderWidth: 2,
    order: series.is_reference ? 1 : 0,
    ...(series.is_bars ? { type: 'bar', barPercentage: 1, categoryPercentage: 0.96, borderWidth: 0, grouped: false, order: 2 } : {}),
  };
}

function tooltipLine(item) {
  const p = item.raw;
  const interval = Number.isFinite(p.low) && Number.isFinite(p.high) ? `  [${format(p.low)}, ${format(p.high)}]` : '';
  return `${item.dataset.label}: ${format(p.y)}${interval}`;
}

function optionsOf(chart, drawn, ink) {
  const visible = drawn.flatMap((series) => series.points.filter((p) => Number.isFinite(p.y)));
  const heights = visible.flatMap((p) => [p.y, p.low, p.high]).filter((y) => canDraw(y, chart.is_y_log));
  if (chart.series.some((series) => series.is_bars)) heights.push(0);
  return {
    animation: false, responsive: true, maintainAspectRatio: false, color: ink.text,
    font: { family: 'system-ui, sans-serif' }, interaction: { mode: 'nearest', intersect: false },
    scales: { x: axis(chart.x_label, chart.is_x_log, visible.map((p) => p.x), false, ink),
              y: axis(chart.y_label, chart.is_y_log, heights, true, ink) },
    plugins: {
      legend: { display: drawn.length > 1, align: 'start', labels: { color: ink.text, usePointStyle: true, boxWidth: 9, boxHeight: 9, padding: 14 } },
      tooltip: { callbacks: { title: (items) => items.length ? `${chart.x_label}: ${format(items[0].raw.x)}` : '', label: tooltipLine } },
    },
  };
}

function drawChart(figure, ink) {
  const chart = report.charts[Number(figure.dataset.chart)];
  const drawn = chart.series.map((series) => ({ series, ...pointsOf(series, chart) }));
  const omitted = drawn.reduce((sum, series) => sum + series.omitted, 0);
  const note = one(figure, '.omitted');
  const reason = chart.is_x_log || chart.is_y_log ? 'not finite, or not positive on a logarithmic axis' : 'not finite';
  note.textContent = `${omitted} ${omitted === 1 ? 'point is' : 'points are'} not drawn (${reason}): see the numbers.`;
  note.hidden = omitted === 0;
  if (!drawn.some((series) => series.points.some((p) => Number.isFinite(p.y)))) { one(figure, '.plot').hidden = true; return null; }
  return new Chart(one(figure, 'canvas'), {
    type: 'line', plugins: [intervals], options: optionsOf(chart, drawn, ink),
    data: { datasets: drawn.map(({ series, points }, i) => datasetOf(series, points, i, ink)) },
  });
}

function setUpCharts() {
  const dark = window.matchMedia('(prefers-color-scheme: dark)');
  let live = [];
  const draw = (ink) => {
    for (const chart of live) chart.destroy();
    live = all(document, '.chart').map((figure) => drawChart(figure, ink)).filter(Boolean);
  };
  const drawForScreen = () => draw(dark.matches ? kInk.dark : kInk.light);
  for (const figure of all(document, '.chart')) {
    const numbers = one(figure, 'details');
    if (numbers) numbers.open = false;
  }
  dark.addEventListener('change', drawForScreen);
  window.addEventListener('beforeprint', () => { draw(kInk.light); for (const chart of live) chart.resize(680, 320); });
  window.addEventListener('afterprint', drawForScreen);
  drawForScreen();
}

// ---------------------------------------------------------------- checks and the rest
function setUpFilter() {
  const filter = one(document, '.filter');
  if (!filter) return;
  const rows = all(document, '.findings tbody tr');
  const select = one(filter, 'select'), search = one(filter, 'input'), output = one(filter, 'output');
  const apply = () => {
    const wanted = search.value.toLowerCase();
    let shown = 0;
    for (const row of rows) {
      const family = one(row.closest('.family'), '.family-name').textContent;
      const text = `${family} ${row.textContent}`.toLowerCase();
      row.hidden = (select.value && !row.classList.contains(select.value)) || !text.includes(wanted);
      shown += row.hidden ? 0 : 1;
    }
    for (const family of all(document, '.family')) family.hidden = !all(family, 'tbody tr').some((row) => !row.hidden);
    output.textContent = shown === rows.length ? '' : `${shown} of ${rows.length}`;
  };
  select.addEventListener('change', apply);
  search.addEventListener('input', apply);
  filter.hidden = rows.length < 2;
}

async function copyText(element) {
  try {
    await navigator.clipboard.writeText(element.textContent);
  } catch (refused) {  // pages opened from a file may not be given the clipboard
    getSelection().selectAllChildren(element);
    document.execCommand('copy');
  }
}

function setUpButtons() {
  for (const button of all(document, '[data-copy]')) {
    button.hidden = false;
    button.addEventListener('click', async () => {
      await copyText(one(button.parentElement, 'code'));
      button.textContent = 'Copied';
      setTimeout(() => { button.textContent = 'Copy'; }, 1500);
    });
  }
  const save = one(document, '[data-save]');
  save.hidden = false;
  save.addEventListener('click', () => {
    const link = document.createElement('a');
    link.href = URL.createObjectURL(new Blob([JSON.stringify(report, null, 2)], { type: 'application/json' }));
    link.download = 'report.json';
    link.click();
    URL.revokeObjectURL(link.href);
  });
}

// Closed parts and filtered rows are opened for paper and put back afterwards.
function setUpPrinting() {
  let closed = [], hidden = [];
  window.addEventListener('beforeprint', () => {
    closed = all(document, 'details:not([open])');
    hidden = all(document, '.family[hidden], .findings tr[hidden]');
    for (const details of closed) details.open = true;
    for (const element of hidden) element.hidden = false;
  });
  window.addEventListener('afterprint', () => {
    for (const details of closed) details.open = false;
    for (const element of hidden) element.hidden = true;
  });
}

document.documentElement.classList.add('js');
setUpButtons();
setUpFilter();
setUpPrinting();
setUpGalleries();
setUpCharts();
})();
