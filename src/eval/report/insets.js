// The same few pixels of every method, enlarged, with their error.

const kInsetSize = 164;  // pixels of the page

// entries: [{name, label, color, shown: canvas, error: () => number or null}]; `choose` is told the name clicked at.
function drawInsets(element, entries, state, choose) {
  if (element.children.length !== entries.length) {
    element.replaceChildren(...entries.map(() => {
      const figure = document.createElement('figure');
      figure.append(document.createElement('canvas'), document.createElement('figcaption'));
      return figure;
    }));
  }
  const ratio = window.devicePixelRatio || 1;
  entries.forEach((entry, i) => {
    const figure = element.children[i], canvas = figure.firstChild;
    figure.style.setProperty('--color', entry.color);
    figure.onclick = () => choose(entry.name);
    if (canvas.width !== Math.round(kInsetSize * ratio)) canvas.width = canvas.height = Math.round(kInsetSize * ratio);
    const context = canvas.getContext('2d'), side = 2 * state.insetHalf;
    context.imageSmoothingEnabled = false;
    context.fillStyle = '#101010';
    context.fillRect(0, 0, canvas.width, canvas.height);
    // Only what there is: a part outside of the picture stays dark.
    const left = state.inset.x - state.insetHalf, top = state.inset.y - state.insetHalf;
    const x0 = Math.max(0, left), y0 = Math.max(0, top);
    const x1 = Math.min(entry.shown.width, left + side), y1 = Math.min(entry.shown.height, top + side);
    const scale = canvas.width / side;
    if (x1 > x0 && y1 > y0)
      context.drawImage(entry.shown, x0, y0, x1 - x0, y1 - y0, (x0 - left) * scale, (y0 - top) * scale, (x1 - x0) * scale, (y1 - y0) * scale);
    const error = entry.error();
    figure.lastChild.innerHTML = `<span>${escapeHtml(entry.label)}</span><span>${error === null ? '' : 'relMSE ' + number(error)}</span>`;
  });
}

// Where to look first: the block of pixels that is worst, but not for one firefly only.
function worstPlace(picture, reference, mean, half) {
  let best = {x: half, y: half, error: -1};
  for (let y = half; y + half <= picture.height; y += half)
    for (let x = half; x + half <= picture.width; x += half) {
      let sum = 0;
      for (let row = y - half; row < y + half; row += 2)
        for (let column = x - half; column < x + half; column += 2)
          sum += Math.min(1, relativeError(picture, reference, mean, 4 * (row * picture.width + column)));
      if (sum > best.error) best = {x, y, error: sum};
    }
  return {x: best.x, y: best.y};
}
