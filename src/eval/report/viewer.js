// The large picture: zoom, pan, flipping between methods, and a slider between two.

class Viewer {
  // `state` holds what is looked at (main.js); `changed` is called when the mouse changes it.
  constructor(stage, state, changed) {
    this.stage = stage;
    this.canvas = stage.querySelector('canvas');
    this.state = state;
    this.changed = changed;
    this.left = this.right = null;  // canvases of the picture's size
    new ResizeObserver(() => this.draw()).observe(stage);
    this.canvas.addEventListener('wheel', event => this.onWheel(event), {passive: false});
    this.canvas.addEventListener('pointerdown', event => this.onDown(event));
    this.canvas.addEventListener('pointermove', event => this.onMove(event));
    this.canvas.addEventListener('pointerup', event => this.onUp(event));
    this.canvas.addEventListener('pointercancel', () => { this.drag = null; });
    this.canvas.addEventListener('dblclick', () => { this.fit(); this.changed(); });
  }

  // What to show; `right` beyond the split, null without a slider.
  show(left, right) {
    const first = !this.left || this.left.width !== left.width || this.left.height !== left.height;
    this.left = left;
    this.right = right;
    if (first || !(this.state.zoom > 0)) this.fit();
    this.draw();
  }

  // The whole picture, as large as the stage lets it be.
  fit() {
    if (!this.left) return;
    const {width, height} = this.stage.getBoundingClientRect();
    this.state.zoom = Math.min(width / this.left.width, height / this.left.height);
    this.state.x = this.left.width / 2;
    this.state.y = this.left.height / 2;
  }

  // The place of the picture's pixel (0, 0) and the size of a pixel, in pixels of the page.
  placement() {
    const {width, height} = this.stage.getBoundingClientRect();
    const {zoom, x, y} = this.state;
    return {left: width / 2 - x * zoom, top: height / 2 - y * zoom, zoom, width, height};
  }

  toPicture(event) {
    const box = this.canvas.getBoundingClientRect(), place = this.placement();
    return {x: (event.clientX - box.left - place.left) / place.zoom, y: (event.clientY - box.top - place.top) / place.zoom};
  }

  draw() {
    if (!this.left) return;
    const place = this.placement(), ratio = window.devicePixelRatio || 1;
    if (place.width < 1 || place.height < 1) return;
    this.canvas.width = Math.round(place.width * ratio);
    this.canvas.height = Math.round(place.height * ratio);
    const context = this.canvas.getContext('2d');
    context.scale(ratio, ratio);
    // Pixels stay pixels when they are enlarged.
    context.imageSmoothingEnabled = place.zoom * ratio < 1;
    context.imageSmoothingQuality = 'high';
    const drawPart = (picture, from, to) => {
      context.save();
      context.beginPath();
      context.rect(from, 0, to - from, place.height);
      context.clip();
      context.drawImage(picture, place.left, place.top, picture.width * place.zoom, picture.height * place.zoom);
      context.restore();
    };
    const split = this.right ? this.state.split * place.width : place.width;
    drawPart(this.left, 0, split);
    if (this.right) {
      drawPart(this.right, split, place.width);
      context.fillStyle = '#fff';
      context.fillRect(split - 1, 0, 2, place.height);
      context.beginPath();
      context.arc(split, place.height / 2, 9, 0, 2 * Math.PI);
      context.fill();
    }
    this.drawFrame(context, place);
  }

  // What the insets show.
  drawFrame(context, place) {
    const {inset, insetHalf} = this.state;
    if (!inset) return;
    const size = 2 * insetHalf * place.zoom;
    const x = place.left + (inset.x - insetHalf) * place.zoom, y = place.top + (inset.y - insetHalf) * place.zoom;
    context.strokeStyle = '#000';
    context.lineWidth = 3;
    context.strokeRect(x, y, size, size);
    context.strokeStyle = this.state.pinned ? '#f2b84b' : '#fff';
    context.lineWidth = 1;
    context.strokeRect(x, y, size, size);
  }

  // Makes the picture `factor` times as large around a place that stays where it is.
  zoomAround(point, factor) {
    const zoom = Math.min(64, Math.max(0.05, this.state.zoom * factor));
    const moved = 1 - this.state.zoom / zoom;
    this.state.x += (point.x - this.state.x) * moved;
    this.state.y += (point.y - this.state.y) * moved;
    this.state.zoom = zoom;
    this.draw();
    this.changed();
  }

  onWheel(event) {
    event.preventDefault();
    this.zoomAround(this.toPicture(event), Math.pow(1.0015, -event.deltaY));
  }

  onDown(event) {
    this.canvas.setPointerCapture(event.pointerId);
    this.canvas.focus({preventScroll: true});
    const box = this.canvas.getBoundingClientRect();
    const onSplit = this.right && Math.abs(event.clientX - box.left - this.state.split * box.width) < 14;
    this.drag = {x: event.clientX, y: event.clientY, fromX: this.state.x, fromY: this.state.y, onSplit, moved: false};
  }

  onMove(event) {
    const box = this.canvas.getBoundingClientRect();
    if (this.drag) {
      const dx = event.clientX - this.drag.x, dy = event.clientY - this.drag.y;
      this.drag.moved = this.drag.moved || Math.hypot(dx, dy) > 3;
      if (this.drag.onSplit) {
        this.state.split = Math.min(1, Math.max(0, (event.clientX - box.left) / box.width));
      } else if (this.drag.moved) {
        this.state.x = this.drag.fromX - dx / this.state.zoom;
        this.state.y = this.drag.fromY - dy / this.state.zoom;
      }
      this.draw();
      return;
    }
    const onSplit = this.right && Math.abs(event.clientX - box.left - this.state.split * box.width) < 14;
    this.canvas.style.cursor = onSplit ? 'ew-resize' : 'crosshair';
    if (this.state.pinned || !this.left) return;
    this.moveInset(this.toPicture(event));
  }

  onUp(event) {
    const clicked = this.drag && !this.drag.moved && !this.drag.onSplit;
    this.drag = null;
    if (!clicked) return;
    this.state.pinned = !this.state.pinned;
    this.moveInset(this.toPicture(event));
  }

  moveInset({x, y}) {
    this.state.inset = {x: Math.round(Math.min(this.left.width, Math.max(0, x))),
                        y: Math.round(Math.min(this.left.height, Math.max(0, y)))};
    this.draw();
    this.changed();
  }
}
