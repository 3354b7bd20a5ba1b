// The page: what is looked at, and who draws it.

const kReference = '\u0000reference';  // no method has such a name
const byId = id => document.getElementById(id);

function colorOf(method) {
  if (method === kReference) return kReferenceColor;
  return kColors[data.methods.findIndex(m => m.name === method) % kColors.length];
}
const labelOf = name => name === kReference ? 'reference' : name;
const isMean = row => !('trimmedRelMse' in row);
// Of the images as rendered, or denoised, whichever the page shows.
const rowsShown = () => data.rows.filter(row => row.denoised === state.denoised);
const rowsOf = scene => rowsShown().filter(row => row.scene === scene.name && !isMean(row));

// ---- What is looked at.

const state = {
  scene: data.scenes[0],
  denoised: false,
  samples: null,              // {spp, equalTime} of the pictures
  shown: null, before: null,  // methods: the one that is shown, and the one before it
  other: kReference,          // beyond the slider
  mode: 'flip', view: 'image', metric: 'trimmedRelMse',
  stops: 0, zoom: 0, x: 0, y: 0, split: 0.5,
  inset: null, insetHalf: 20, pinned: false,
};

// The methods whose pictures are there for the chosen samples, with their ids; at equal time the first method is
// the one that set the time.
function pictures() {
  const {spp, equalTime} = state.samples;
  return data.methods.flatMap((method, i) => {
    const found = state.scene.pictures.find(p => p.method === method.name && p.spp === spp && p.equalTime === (equalTime && i > 0) && p.denoised === state.denoised);
    return found ? [found] : [];
  });
}

// ---- Buttons of which one is chosen: [{value, text, color}].

function drawButtons(element, options, chosen, choose) {
  element.replaceChildren(...options.map(option => {
    const button = document.createElement('button');
    button.type = 'button';
    button.textContent = option.text;
    button.title = option.title || '';
    button.setAttribute('aria-pressed', String(option.value === chosen));
    if (option.color) button.style.setProperty('--color', option.color);
    button.onclick = () => choose(option.value);
    return button;
  }));
}

// ---- Pictures.

const painted = new Map();  // the latest canvases, by what they show
function remember(key, make) {
  if (!painted.has(key)) {
    if (painted.size > 80) painted.clear();
    painted.set(key, make());
  }
  return painted.get(key);
}

// The canvas of a method, or of the reference, as it is to be seen now. Errors need the reference's picture.
async function canvasOf(name) {
  const scene = state.scene, view = state.view, stops = state.stops;
  const entry = name === kReference ? null : pictures().find(p => p.method === name);
  const picture = await loadPicture(entry ? entry.id : scene.referencePicture);
  if (view === 'image') return remember(`${picture.id} ${stops}`, () => paintImage(picture, stops));
  if (view === 'flip' && entry) {
    const map = await loadPicture(entry.flip);
    return remember(map.id, () => paintFlip(map));
  }
  const reference = await loadPicture(scene.referencePicture);
  return remember(`${picture.id} error`, () => paintError(picture, reference, scene.mean));
}

const viewer = new Viewer(byId('stage'), state, () => refreshInsets());
let turn = 0;  // of drawing: what was overtaken while it waited is dropped

async function refreshPicture() {
  const mine = ++turn;
  const left = await canvasOf(state.shown);
  const right = state.mode === 'slider' ? await canvasOf(state.other) : null;
  if (mine !== turn) return;
  byId('caption').textContent = caption(state.shown);
  byId('caption-right').textContent = right ? caption(state.other) : '';
  byId('legend').innerHTML = legend();
  viewer.show(left, right);
  await refreshInsets();
}

function caption(name) {
  const row = rowsOf(state.scene).find(r => r.method === name && pictures().some(p => p.method === name && p.spp === r.spp && p.equalTime === r.equalTime));
  if (!row) return 'reference';
  return `${name}, ${samplesText(row)} spp · error ${number(row.trimmedRelMse)} · FLIP ${number(row.flip)} · ${number(row.cpuSeconds)} CPU s`;
}

function legend() {
  if (state.view === 'image') return '';
  const ends = state.view === 'flip' ? ['0', 'FLIP', '1'] : [kLeastError, '(I − R)² / (R² + 0.01)', kMostError];
  return `<i style="background:${kMagmaCss}"></i><span>${ends.map(end => `<b>${end}</b>`).join('')}</span>`;
}

let insetTurn = 0;
async function refreshInsets() {
  byId('zoom-text').textContent = `${Math.round(100 * state.zoom)} %`;
  const mine = ++insetTurn, scene = state.scene, there = pictures();
  const reference = await loadPicture(scene.referencePicture);
  const loadedPictures = await Promise.all(there.map(p => loadPicture(p.id)));
  const shown = await Promise.all([...there.map(p => p.method), kReference].map(canvasOf));
  if (mine !== insetTurn) return;
  if (!state.inset) {
    state.inset = worstPlace(loadedPictures[0], reference, scene.mean, state.insetHalf);
    viewer.draw();
  }
  const entries = there.map((p, i) => ({
    name: p.method, label: p.method, color: colorOf(p.method), shown: shown[i],
    error: () => localError(loadedPictures[i], reference, scene.mean, state.inset.x, state.inset.y, state.insetHalf)}));
  entries.push({name: kReference, label: 'reference', color: kReferenceColor, shown: shown[there.length], error: () => null});
  drawInsets(byId('insets'), entries, state, choosePicture);
}

// ---- Controls of the viewer.

function choosePicture(name) {
  if (name !== state.shown) state.before = state.shown;
  state.shown = name;
  refreshControls();
  refreshPicture();
}

function refreshControls() {
  const sets = [];
  for (const p of state.scene.pictures)
    if (p.denoised === state.denoised && !sets.some(s => s.spp === p.spp && s.equalTime === p.equalTime)) sets.push({spp: p.spp, equalTime: p.equalTime});
  sets.sort((a, b) => a.equalTime - b.equalTime || a.spp - b.spp);
  const same = set => state.samples && set.spp === state.samples.spp && set.equalTime === state.samples.equalTime;
  state.samples = sets.find(same) || sets[0];
  const methods = pictures().map((p, i) => ({value: p.method, text: p.method, color: colorOf(p.method), title: `key ${i + 1}`}));
  methods.push({value: kReference, text: 'reference', color: kReferenceColor, title: 'key R'});
  if (!methods.some(m => m.value === state.shown)) state.shown = methods[0].value;
  if (!methods.some(m => m.value === state.before)) state.before = methods[Math.min(1, methods.length - 1)].value;
  if (!methods.some(m => m.value === state.other)) state.other = kReference;

  const choose = key => value => { state[key] = value; refreshControls(); refreshPicture(); };
  drawButtons(byId('samples'), sets.map(s => ({value: s, text: s.equalTime ? `time of ${s.spp}` : String(s.spp)})), state.samples, choose('samples'));
  drawButtons(byId('views'), [{value: 'image', text: 'image'}, {value: 'error', text: 'relative error'}, {value: 'flip', text: 'FLIP'}], state.view, choose('view'));
  drawButtons(byId('modes'), [{value: 'flip', text: 'flipping'}, {value: 'slider', text: 'slider'}], state.mode, choose('mode'));
  drawButtons(byId('methods'), methods, state.shown, choosePicture);
  drawButtons(byId('others'), methods, state.other, choose('other'));
  drawButtons(byId('zooms'), [{value: 0, text: 'fit'}, {value: 1, text: '1:1'}, {value: 4, text: '4:1'}], null, zoom => {
    if (zoom === 0) { viewer.fit(); viewer.draw(); refreshInsets(); }
    else viewer.zoomAround(state.inset || {x: state.x, y: state.y}, zoom / state.zoom);
  });
  document.body.classList.toggle('slider', state.mode === 'slider');
  byId('exposure').value = state.stops;
  byId('exposure-text').textContent = `${state.stops > 0 ? '+' : ''}${state.stops.toFixed(1)} stops`;
}

function setExposure(stops) {
  state.stops = Math.min(8, Math.max(-8, Math.round(stops * 10) / 10));
  refreshControls();
  refreshPicture();
}

function onKey(event) {
  if (event.ctrlKey || event.metaKey || event.altKey || /^(INPUT|TEXTAREA|SELECT)$/.test(event.target.tagName)) return;
  const methods = pictures().map(p => p.method);
  const next = (key, values) => { state[key] = values[(values.indexOf(state[key]) + 1) % values.length]; refreshControls(); refreshPicture(); };
  if (/^[1-9]$/.test(event.key) && methods[event.key - 1]) choosePicture(methods[event.key - 1]);
  else if (event.key === 'r' || event.key === 'R') choosePicture(kReference);
  else if (event.key === ' ' && event.target.tagName !== 'BUTTON') choosePicture(state.before);
  else if (event.key === 's' || event.key === 'S') next('mode', ['flip', 'slider']);
  else if (event.key === 'e' || event.key === 'E') next('view', ['image', 'error', 'flip']);
  else if ((event.key === 'd' || event.key === 'D') && data.denoiser) chooseDenoised(!state.denoised);
  else if (event.key === '+' || event.key === '=') setExposure(state.stops + 0.5);
  else if (event.key === '-') setExposure(state.stops - 0.5);
  else if (event.key === '0') { viewer.fit(); setExposure(0); }
  else return;
  event.preventDefault();
}

// ---- Figures of the scene.

const kMetrics = [['trimmedRelMse', 'trimmed relMSE'], ['relMse', 'relMSE'], ['smape', 'SMAPE'], ['flip', 'FLIP']];

function refreshCharts() {
  const rows = rowsOf(state.scene), metric = state.metric, label = kMetrics.find(m => m[0] === metric)[1];
  drawButtons(byId('metrics'), kMetrics.map(([value, text]) => ({value, text})), metric, value => { state.metric = value; refreshCharts(); });
  const seriesBy = x => data.methods.map(method => ({
    name: method.name, color: colorOf(method.name),
    points: rows.filter(r => r.method === method.name).map(r => {
      const errors = data.runs.filter(run => run.scene === r.scene && run.method === r.method && run.spp === r.spp && run.equalTime === r.equalTime && run.denoised === r.denoised).map(run => run[metric]);
      return {x: x(r), y: r[metric], low: Math.min(...errors), high: Math.max(...errors), hollow: r.equalTime,
        title: `${r.method}, ${samplesText(r)} spp: ${label} ${number(r[metric])} (${number(Math.min(...errors))} to ${number(Math.max(...errors))} over ${r.seeds} seeds), ${number(r.cpuSeconds)} CPU s`};
    })}));
  const ticks = [...new Set(rows.map(r => r.spp))];
  const own = state.scene.referenceError && state.scene.referenceError[metric];
  const levels = own ? [{y: own, label: 'reference'}] : [];
  drawCurves(byId('samples-chart'), seriesBy(r => r.samples), 'samples per pixel', label, levels, ticks);
  drawCurves(byId('time-chart'), seriesBy(r => r.cpuSeconds), 'seconds of the processor', label, levels);
  byId('reference-note').textContent = 'Whiskers: the least and the most of all seeds; hollow: at equal time. ' + (own
    ? `Dashed: the reference's own error, ${number(own)}, is part of all.`
    : /relMse/i.test(metric) ? 'The own error of this reference is not known.' : 'What of it is the reference\'s is told for relMSE only.');
}

function chooseScene(scene) {
  state.scene = scene;
  state.inset = null;
  state.pinned = false;
  state.zoom = 0;
  for (const button of byId('scenes').children) button.setAttribute('aria-selected', String(button.dataset.scene === scene.name));
  refreshControls();
  refreshPicture();
  refreshCharts();
  drawTable(byId('scene-table'), columnsOf({figures: true}), rowsOf(scene));
}

function drawFigures() {
  drawTable(byId('all-table'), columnsOf({scene: true, figures: true}), rowsShown().filter(r => !isMean(r)));
}

// Shows everything of the images as rendered, or denoised.
function chooseDenoised(denoised) {
  state.denoised = denoised;
  byId('denoised-choice').hidden = !data.denoiser;
  drawButtons(byId('denoised'), [{value: false, text: 'as rendered'}, {value: true, text: 'denoised', title: `key D; ${data.denoiser}`}], denoised, chooseDenoised);
  drawOverview();
  drawFigures();
  refreshControls();
  refreshPicture();
  refreshCharts();
  drawTable(byId('scene-table'), columnsOf({figures: true}), rowsOf(state.scene));
}

function drawScenes() {
  byId('scenes').replaceChildren(...data.scenes.map(scene => {
    const button = document.createElement('button');
    button.type = 'button';
    button.dataset.scene = scene.name;
    button.setAttribute('role', 'tab');
    button.innerHTML = `<canvas></canvas><b>${escapeHtml(scene.name)}</b><small>${scene.width} × ${scene.height}</small>`;
    button.onclick = () => chooseScene(scene);
    loadPicture(scene.referencePicture).then(picture => {
      const canvas = button.querySelector('canvas');
      canvas.width = picture.width;
      canvas.height = picture.height;
      canvas.getContext('2d').drawImage(paintImage(picture, 0), 0, 0);
    });
    return button;
  }));
}

function start() {
  const seeds = Math.max(...data.rows.map(r => r.seeds));
  byId('headline').textContent = `${data.methods.map(m => m.name).join(', ')} · ${data.scenes.length} ${data.scenes.length === 1 ? 'scene' : 'scenes'} · ${seeds} ${seeds === 1 ? 'seed' : 'seeds'} · odis ${data.version}`;
  for (const element of document.querySelectorAll('.first-method')) element.textContent = data.methods[0].name;
  byId('exposure').oninput = event => setExposure(Number(event.target.value));
  byId('exposure').ondblclick = () => setExposure(0);
  document.addEventListener('keydown', onKey);
  drawProvenance();
  drawScenes();
  chooseScene(data.scenes[0]);
  chooseDenoised(false);
}
start();
