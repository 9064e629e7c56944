#pragma once

#include <string_view>

namespace rondure::reports {

/// The only script of the page: turns the drawing in three dimensions, switches the theme, makes
/// scrolling boxes reachable by keyboard. It loads and stores nothing, and the page is complete
/// without it. The page's Content-Security-Policy names its digest, so no other script can run.
inline constexpr std::string_view kScript = R"js(//<![CDATA[
'use strict';
(() => {
  const root = document.documentElement;
  const each = (from, what, act) => from.querySelectorAll(what).forEach(act);
  const numbers = (text) => text.split(' ').map((t) => (t === '-' ? NaN : Number(t)));
  const RAD = Math.PI / 180;

  // Theme: that of the system until the button is pressed; forgotten with the page.
  const system = matchMedia('(prefers-color-scheme: dark)');
  const theme = document.querySelector('.theme');
  const dark = () => (root.dataset.theme ? root.dataset.theme === 'dark' : system.matches);
  const show = () => theme.setAttribute('aria-pressed', String(dark()));
  theme.hidden = false;
  theme.onclick = () => { root.dataset.theme = dark() ? 'light' : 'dark'; show(); };
  system.onchange = show;
  show();

  // What is wider than the screen can be scrolled with the keyboard.
  const reach = () => each(document, '.scroll', (box) => {
    if (box.scrollWidth > box.clientWidth + 1) {
      const named = box.querySelector('caption, [aria-label]');
      box.tabIndex = 0;
      box.setAttribute('role', 'group');
      if (named) box.setAttribute('aria-label', named.getAttribute('aria-label') || named.textContent);
    } else {
      for (const name of ['tabindex', 'role', 'aria-label']) box.removeAttribute(name);
    }
  });
  addEventListener('resize', reach);
  reach();

  // The cylinder: the same projection as solid_scene.cpp and plot_solid.cpp.
  const solid = (figure) => {
    const svg = figure.querySelector('svg');
    const tools = figure.querySelector('.tools');
    const told = tools.querySelector('output');
    const [cx, cy] = numbers(tools.dataset.centre);
    const half = Number(tools.dataset.half);
    const start = numbers(tools.dataset.view);
    const far = svg.querySelector('.far');
    const near = svg.querySelector('.near');
    const rings = near.querySelectorAll('.ring');
    const farRings = far.querySelectorAll('.ring');
    const lines = [...rings].map((path) => numbers(path.dataset.ring));
    const marks = [...svg.querySelectorAll('[data-p]')].map((item) => ({
      item, p: numbers(item.dataset.p), o: numbers(item.dataset.o || '0 0'),
      tail: item.tagName === 'path' ? item.getAttribute('d').replace(/^M\S+ [-.\d]+/, '') : ''}));
    let [yaw, pitch] = start;

    const at = (angle, radius, height) => {
      const turned = (angle + yaw) * RAD;
      const away = radius * Math.sin(turned);
      return [cx + radius * Math.cos(turned),
              cy - away * Math.sin(pitch * RAD) - height * Math.cos(pitch * RAD), away < 0];
    };
    const text = ([x, y]) => x.toFixed(1) + ' ' + y.toFixed(1);
    const halves = ([height, ...radii]) => {
      const steps = radii.length === 1 ? 60 : radii.length;
      const d = {true: '', false: ''};
      let last = null;
      for (let i = 0; i < steps; i++) {
        const a = radii[i % radii.length], b = radii[(i + 1) % radii.length];
        const side = at((i + 0.5) * 360 / steps, 1, 0)[2];
        if (!isFinite(a + b)) { last = null; continue; }
        if (last !== side) d[side] += 'M' + text(at(i * 360 / steps, a, height));
        d[side] += 'L' + text(at((i + 1) * 360 / steps, b, height));
        last = side;
      }
      return d;
    };
    const outline = (r) => {
      const flank = half * Math.cos(pitch * RAD), flat = r * Math.abs(Math.sin(pitch * RAD));
      const arc = 'A' + r.toFixed(1) + ' ' + flat.toFixed(1) + ' 0 0 0 ';
      return 'M' + text([cx - r, cy - flank]) + 'L' + text([cx - r, cy + flank]) + arc +
        text([cx + r, cy + flank]) + 'L' + text([cx + r, cy - flank]) + arc +
        text([cx - r, cy - flank]) + 'Z';
    };
    const draw = () => {
      const flank = half * Math.cos(pitch * RAD);
      rings.forEach((path, i) => {
        const d = halves(lines[i]);
        path.setAttribute('d', d[true]);
        farRings[i].setAttribute('d', d[false]);
        const end = path.classList.contains('outside') && lines[i][0] * pitch > 0;
        farRings[i].classList.toggle('away', !end);
      });
      for (const {item, p, o, tail} of marks) {
        const [x, y, faces] = at(...p);
        if (item.tagName === 'text') {
          item.setAttribute('x', x.toFixed(1));
          item.setAttribute('y', (y + 4).toFixed(1));
          continue;
        }
        if (tail) {
          item.setAttribute('d', 'M' + text([x + o[0], y + o[1]]) + tail);
        } else {
          item.setAttribute('cx', x.toFixed(1));
          item.setAttribute('cy', y.toFixed(1));
        }
        const side = faces ? near : far;
        if (item.parentNode !== side) side.appendChild(item);
      }
      each(svg, '[data-body]', (path) => path.setAttribute('d', outline(Number(path.dataset.body))));
      each(svg, '[data-cap]', (cap) => {
        cap.setAttribute('cy', (cy - (pitch < 0 ? -flank : flank)).toFixed(1));
        cap.setAttribute('ry', (cap.dataset.cap * Math.abs(Math.sin(pitch * RAD))).toFixed(1));
      });
      each(svg, '[data-h]', (label) => {
        label.setAttribute('y', (cy - label.dataset.h * Math.cos(pitch * RAD) + 4).toFixed(1));
      });
      const end = (half + 26) * Math.cos(pitch * RAD);
      const axis = svg.querySelector('.solid-axis');
      axis.setAttribute('y1', (cy - end).toFixed(1));
      axis.setAttribute('y2', (cy + end).toFixed(1));
      told.textContent = tools.dataset.words.replace('{}', Math.round(yaw))
        .replace('{}', Math.round(pitch));
    };
    const turn = (by, up) => {
      yaw = ((yaw + by + 540) % 360) - 180;
      pitch = Math.max(-90, Math.min(90, pitch + up));
      draw();
    };
    const reset = () => { [yaw, pitch] = start; draw(); };

    tools.hidden = false;
    each(figure, '.turn-note', (note) => { note.hidden = false; });
    each(tools, 'button', (button) => {
      button.onclick = () => (button.dataset.turn === 'reset' ? reset()
                                                              : turn(...numbers(button.dataset.turn)));
    });
    svg.tabIndex = 0;
    svg.setAttribute('role', 'application');
    const keys = {ArrowLeft: [-5, 0], ArrowRight: [5, 0], ArrowUp: [0, -5], ArrowDown: [0, 5]};
    svg.onkeydown = (event) => {
      if (event.ctrlKey || event.altKey || event.metaKey) return;
      if (event.key === 'Home') reset();
      else if (keys[event.key]) turn(...keys[event.key]);
      else return;
      event.preventDefault();
    };
    let held = null;
    svg.onpointerdown = (event) => {
      held = [event.clientX, event.clientY];
      svg.setPointerCapture(event.pointerId);
    };
    svg.onpointermove = (event) => {
      if (!held) return;
      turn((event.clientX - held[0]) / 2, (event.clientY - held[1]) / 2);
      held = [event.clientX, event.clientY];
    };
    svg.onpointerup = svg.onpointercancel = () => { held = null; };
    draw();
  };
  each(document, 'figure.solid', solid);
})();
//]]>)js";

}  // namespace rondure::reports
