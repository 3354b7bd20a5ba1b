// Pictures: from what the page carries to what is shown. They are PNGs whose bytes are logarithms of linear light
// (kPictureScale and kPictureMost in src/eval/report_pictures.h), so that the exposure can be chosen here.

const data = JSON.parse(document.getElementById('data').textContent);
// A comparison that was interrupted may have a scene without a result.
data.scenes = data.scenes.filter(scene => data.rows.some(row => row.scene === scene.name));

// Linear light of each byte, in units of what the screen shows as white.
const kLinear = Float32Array.from({length: 256}, (_, byte) =>
  (Math.pow(1 + data.encoding.scale * data.encoding.most, byte / 255) - 1) / data.encoding.scale);

// The bytes (RGBA) of an embedded PNG, decoded once.
const loaded = new Map();
function loadPicture(id) {
  if (!loaded.has(id)) loaded.set(id, decodePicture(id));
  return loaded.get(id);
}
async function decodePicture(id) {
  const image = new Image();
  image.src = 'data:image/png;base64,' + document.getElementById(id).textContent.trim();
  await image.decode();
  const canvas = document.createElement('canvas');
  canvas.width = image.naturalWidth;
  canvas.height = image.naturalHeight;
  const context = canvas.getContext('2d', {willReadFrequently: true});
  context.drawImage(image, 0, 0);
  return {id, width: canvas.width, height: canvas.height, bytes: context.getImageData(0, 0, canvas.width, canvas.height).data};
}

// The curve of render/film/tonemap.h: the identity up to a shoulder, then rolled off; and sRGB.
function screenByte(linear) {
  const shoulder = 0.6;
  const x = linear > shoulder ? 1 - (1 - shoulder) * Math.exp(-(linear - shoulder) / (1 - shoulder)) : linear;
  const stored = x <= 0.0031308 ? 12.92 * x : 1.055 * Math.pow(x, 1 / 2.4) - 0.055;
  return Math.round(255 * Math.min(1, stored));
}

// Black over violet and orange to a pale yellow: small to large.
const kMagma = ['000004', '180f3d', '440f76', '721f81', '9e2f7f', 'cd4071', 'f1605d', 'fd9668', 'feca8d', 'fcfdbf']
  .map(hex => [0, 2, 4].map(i => parseInt(hex.slice(i, i + 2), 16)));
const kMagmaCss = `linear-gradient(to right, ${kMagma.map(c => `rgb(${c})`).join(', ')})`;
function magma(share) {
  const at = Math.min(1, Math.max(0, share)) * (kMagma.length - 1), i = Math.min(kMagma.length - 2, Math.floor(at));
  return kMagma[i].map((from, c) => from + (kMagma[i + 1][c] - from) * (at - i));
}
const kMagmaTable = Array.from({length: 256}, (_, i) => magma(i / 255));

// A canvas of the picture's size, its pixels written by fill(bytes).
function paint(picture, fill) {
  const canvas = document.createElement('canvas');
  canvas.width = picture.width;
  canvas.height = picture.height;
  const context = canvas.getContext('2d');
  const pixels = context.createImageData(picture.width, picture.height);
  pixels.data.fill(255);
  fill(pixels.data);
  context.putImageData(pixels, 0, 0);
  return canvas;
}

function paintImage(picture, stops) {
  const table = Uint8Array.from(kLinear, linear => screenByte(linear * Math.pow(2, stops)));
  return paint(picture, out => {
    for (let i = 0; i < out.length; i += 4)
      for (let c = 0; c < 3; ++c) out[i + c] = table[picture.bytes[i + c]];
  });
}

// (I - R)^2 / (R^2 + 0.01) of the pixel that starts at byte i, both over the reference's mean luminance.
function relativeError(picture, reference, mean, i) {
  let sum = 0;
  for (let c = 0; c < 3; ++c) {
    const value = kLinear[picture.bytes[i + c]] / mean, truth = kLinear[reference.bytes[i + c]] / mean;
    sum += (value - truth) * (value - truth) / (truth * truth + 0.01) / 3;
  }
  return sum;
}

// The colours of errors from kLeastError to kMostError, in logarithms.
const kLeastError = 1e-3, kMostError = 10;
function paintError(picture, reference, mean) {
  const range = Math.log(kMostError / kLeastError);
  return paint(picture, out => {
    for (let i = 0; i < out.length; i += 4) {
      const share = Math.log(Math.max(relativeError(picture, reference, mean, i), 1e-12) / kLeastError) / range;
      const color = kMagmaTable[Math.round(255 * Math.min(1, Math.max(0, share)))];
      for (let c = 0; c < 3; ++c) out[i + c] = color[c];
    }
  });
}

// The embedded FLIP map is grey, 255 is 1.
function paintFlip(picture) {
  return paint(picture, out => {
    for (let i = 0; i < out.length; i += 4)
      for (let c = 0; c < 3; ++c) out[i + c] = kMagmaTable[picture.bytes[i]][c];
  });
}

// relMSE of a square of pixels, half of its side given.
function localError(picture, reference, mean, x, y, half) {
  let sum = 0, count = 0;
  for (let row = Math.max(0, y - half); row < Math.min(picture.height, y + half); ++row)
    for (let column = Math.max(0, x - half); column < Math.min(picture.width, x + half); ++column, ++count)
      sum += relativeError(picture, reference, mean, 4 * (row * picture.width + column));
  return count > 0 ? sum / count : 0;
}
