// SPDX-License-Identifier: GPL-3.0-or-later
// The appearance of a region's surface, and the row of controls that changes it.
import type * as THREE from 'three';
import { element, setSlider, slider, switchOf } from './dom';

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

/** The row of controls of a surface. @param changed called after the opacity or the visibility has changed */
export function regionRow(surface: { visible: boolean; opacity: number }, name: string, color: string, changed: () => void): HTMLElement {
  const row = element('div', 'region');
  const opacity = slider(`Opacity of ${name}`, '0.01', (value) => {
    surface.opacity = value;
    changed();
  });
  setSlider(opacity, 0, 1, surface.opacity);
  row.append(switchOf(name, surface.visible, color, (on) => {
    surface.visible = on;
    changed();
  }), opacity);
  return row;
}

/** The name of a region in its row. */
export function rowName({ label, target }: { label: string; target: boolean }): string {
  return label + (target ? ' (target)' : '');
}
