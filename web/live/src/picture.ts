// SPDX-License-Identifier: GPL-3.0-or-later
// Makes a picture file of the page: 3D view, sections and curves, with the case and the state of the needle above and
// the notice "not a medical device" below.
import { viridis } from '../../shared/colors';
import { INK, SOFT, WARN } from './palette';
import type { Session } from './session';

export interface PictureParts {
  view: HTMLCanvasElement | null;
  sections: { title: string; canvas: HTMLCanvasElement }[];
  chart: HTMLCanvasElement | null;
  largest_mm: number | null;  // end of the colour scale; null unless colours show the displacement
}

function fit(source: HTMLCanvasElement, width: number, height: number): { width: number; height: number } {
  const scale = Math.min(width / source.width, height / source.height);
  return { width: source.width * scale, height: source.height * scale };
}

type Text = (what: string, x: number, y: number, size: number, color: string, weight?: number) => void;

function colorScale(context: CanvasRenderingContext2D, largest: number, x: number, y: number, width: number, text: Text): void {
  const color = new Float32Array(3);
  for (let i = 0; i < width; i++) {
    viridis(i / (width - 1), color, 0);
    context.fillStyle = `rgb(${[...color].map((c) => Math.round(255 * c)).join(',')})`;
    context.fillRect(x + i, y, 1, 18);
  }
  text(`moved by 0 … ${largest} mm`, x + 60, y - 10, 20, SOFT);
}

/**
 * Draws into a canvas of 1920 × 1200 pixels. The 3D view must have been rendered in the same task of the event loop.
 */
export function compose(session: Session, parts: PictureParts): HTMLCanvasElement {
  const [width, height, gap] = [1920, 1200, 24];
  const canvas = document.createElement('canvas');
  canvas.width = width;
  canvas.height = height;
  const context = canvas.getContext('2d') as CanvasRenderingContext2D;
  const family = getComputedStyle(document.body).fontFamily;
  const text = (what: string, x: number, y: number, size: number, color: string, weight = 400) => {
    context.font = `${weight} ${size}px ${family}`;
    context.fillStyle = color;
    context.fillText(what, x, y);
  };
  context.fillStyle = '#fff';
  context.fillRect(0, 0, width, height);
  const { scene, frame, status } = session;
  text(scene?.name ?? 'Stylet', gap, 52, 34, INK, 650);
  if (frame) {
    const [axial, sagittal, lateral] = frame.force;
    const where = status?.hole ? `hole ${status.hole}, ` : '';
    text(`${where}${frame.time.toFixed(2)} s, depth ${frame.depth.toFixed(1)} mm, force axial ${axial.toFixed(2)} N, sagittal ${sagittal.toFixed(2)} N, lateral ${lateral.toFixed(2)} N`.replaceAll('-', '−')
         + (frame.trusted ? '' : ' (do not trust these forces)'), gap, 90, 24, SOFT);
  }
  const top = 112;
  const chartHeight = 300;
  const bottom = height - 56 - chartHeight - gap;
  const left = 0.58 * (width - 3 * gap);
  const put = (source: HTMLCanvasElement, x: number, y: number, w: number, h: number) => {
    context.strokeStyle = '#d9dce0';
    context.strokeRect(x, y, w, h);
    const size = fit(source, w, h);
    context.drawImage(source, x + (w - size.width) / 2, y + (h - size.height) / 2, size.width, size.height);
  };
  const sectionsLeft = parts.view ? left + 2 * gap : gap;
  if (parts.view) put(parts.view, gap, top, left, bottom - top);
  if (parts.view && parts.largest_mm !== null) colorScale(context, parts.largest_mm, gap + left / 2 - 150, bottom - 50, 300, text);
  const each = (bottom - top - gap) / 2;
  parts.sections.forEach(({ title, canvas: source }, i) => {
    const y = top + i * (each + gap);
    put(source, sectionsLeft, y, width - gap - sectionsLeft, each);
    text(title, sectionsLeft + 12, y + 28, 20, INK, 600);
  });
  if (parts.chart) put(parts.chart, gap, bottom + gap, width - 2 * gap, chartHeight);
  const notice = scene?.notice || 'Not a medical device.';
  text(`${notice} Stylet ${scene?.version ?? ''}, ${new Date().toISOString().slice(0, 19).replace('T', ' ')} UTC`, gap, height - 22, 20, WARN, 600);
  return canvas;
}

export function save(canvas: HTMLCanvasElement, name: string): void {
  canvas.toBlob((blob) => {
    if (!blob) return;
    const link = document.createElement('a');
    link.href = URL.createObjectURL(blob);
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
  }, 'image/png');
}
