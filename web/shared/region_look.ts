// SPDX-License-Identifier: GPL-3.0-or-later
// The appearance of a region's surface, and the row of controls that changes it.
import type * as THREE from 'three';
import { element } from './dom';

const HARDLY = 0.005;  // surfaces with less opacity are invisible
const OPAQUE = 0.99;

/** A region's surface in a 3D view. */
export interface RegionLook {
  readonly region: { label: string; color: string; target: boolean; background: boolean };
  readonly object: THREE.Mesh<THREE.BufferGeometry, THREE.MeshStandardMaterial>;
  visible: boolean;
  opacity: number;
}

export function isShown({ visible, opacity }: RegionLook): boolean {
  return visible && opacity > HARDLY;
}

export function applyLook(surface: RegionLook, byDisplacement: boolean): void {
  const { material } = surface.object;
  const opaque = surface.opacity > OPAQUE;
  if (material.transparent === opaque) material.needsUpdate = true;
  // Colours that stand for numbers must not mix with the colours behind, so they are more opaque than tissue colours.
  material.opacity = byDisplacement && !surface.region.background ? 1 - (1 - surface.opacity) ** 2 : surface.opacity;
  material.transparent = !opaque;
  material.depthWrite = opaque;
  surface.object.visible = isShown(surface);
}

/** Shows the displacement by the colours of the geometry, or the tissue's own colour. */
export function applyColors(surface: RegionLook, byDisplacement: boolean): void {
  const { material } = surface.object;
  applyLook(surface, byDisplacement);
  material.vertexColors = byDisplacement;
  material.color.set(byDisplacement ? '#ffffff' : surface.region.color);
  material.needsUpdate = true;
}

/** The row of controls of a region. @param changed called after the opacity or the visibility has changed */
export function regionRow(surface: RegionLook, changed: () => void): HTMLElement {
  const { region } = surface;
  const row = element('div', 'region');
  const label = element('label');
  const box = element('input');
  box.type = 'checkbox';
  box.checked = surface.visible;
  box.addEventListener('change', () => {
    surface.visible = box.checked;
    changed();
  });
  const swatch = element('span', 'swatch');
  swatch.style.background = region.color;
  label.append(box, swatch, region.label + (region.target ? ' (target)' : ''));
  const slider = element('input');
  slider.type = 'range';
  slider.min = '0';
  slider.max = '1';
  slider.step = '0.01';
  slider.value = String(surface.opacity);
  slider.setAttribute('aria-label', `Opacity of ${region.label}`);
  slider.addEventListener('input', () => {
    surface.opacity = slider.valueAsNumber;
    changed();
  });
  row.append(label, slider);
  return row;
}
