// SPDX-License-Identifier: GPL-3.0-or-later
// A plane that cuts the anatomy open. The cut through a region is filled with its colour. The stencil buffer counts the
// faces behind each point of the plane: exactly inside a closed surface, there are more back faces than front faces.
import * as THREE from 'three';
import type { RegionSurface } from './region_surface';

const FIRST = -200;  // render order before all translucent surfaces

export class CutPlane {
  readonly object = new THREE.Group();
  /** The clipping planes of materials: one or none. */
  readonly clipping: THREE.Plane[] = [];
  private readonly plane = new THREE.Plane(new THREE.Vector3(0, 0, 1), 0);
  private readonly caps: { surface: RegionSurface; parts: THREE.Mesh[]; quad: THREE.Mesh }[] = [];
  private axis: 0 | 1 | 2 | null = null;
  private value = 0;
  private side: 1 | -1 = 1;

  setSurfaces(surfaces: RegionSurface[], size: number): void {
    this.clear();
    surfaces.forEach((surface, i) => {
      const parts = [this.counter(surface, THREE.BackSide, THREE.IncrementWrapStencilOp),
                     this.counter(surface, THREE.FrontSide, THREE.DecrementWrapStencilOp)];
      for (const part of parts) part.renderOrder = FIRST + i;
      const quad = new THREE.Mesh(new THREE.PlaneGeometry(size, size), new THREE.MeshBasicMaterial({
        color: surface.region.color, transparent: true, opacity: surface.region.background ? 0.3 : 0.8, side: THREE.DoubleSide,
        stencilWrite: true, stencilRef: 0, stencilFunc: THREE.NotEqualStencilFunc,
        stencilFail: THREE.ReplaceStencilOp, stencilZFail: THREE.ReplaceStencilOp, stencilZPass: THREE.ReplaceStencilOp,
      }));
      quad.renderOrder = FIRST + i + 0.5;
      quad.onAfterRender = (renderer) => renderer.clearStencil();
      this.object.add(...parts, quad);
      this.caps.push({ surface, parts, quad });
    });
    this.place(this.axis, this.value, this.side);
  }

  /** Removes the anatomy on one side of a plane perpendicular to an axis. @param axis null: removes nothing */
  place(axis: 0 | 1 | 2 | null, value: number, side: 1 | -1): void {
    [this.axis, this.value, this.side] = [axis, value, side];
    this.clipping.length = 0;
    this.object.visible = axis !== null;
    if (axis === null) return;
    this.clipping.push(this.plane);
    this.plane.normal.set(0, 0, 0).setComponent(axis, -side);
    this.plane.constant = side * value;
    const away = new THREE.Vector3();
    for (const { surface, parts, quad } of this.caps) {
      for (const mesh of [...parts, quad]) mesh.visible = surface.shown;
      quad.position.copy(surface.centre).setComponent(axis, value);
      quad.lookAt(away.copy(quad.position).add(this.plane.normal));
    }
  }

  /** Must be called when surfaces are shown or hidden. */
  refresh(): void {
    this.place(this.axis, this.value, this.side);
  }

  private counter(surface: RegionSurface, side: THREE.Side, operation: THREE.StencilOp): THREE.Mesh {
    const mesh = new THREE.Mesh(surface.object.geometry, new THREE.MeshBasicMaterial({
      transparent: true,  // so that it is drawn in the same pass as the filling
      depthWrite: false, depthTest: false, colorWrite: false, side, clippingPlanes: this.clipping,
      stencilWrite: true, stencilFunc: THREE.AlwaysStencilFunc, stencilFail: operation, stencilZFail: operation, stencilZPass: operation,
    }));
    mesh.frustumCulled = false;
    return mesh;
  }

  private clear(): void {
    for (const { parts, quad } of this.caps) {
      for (const part of parts) (part.material as THREE.Material).dispose();
      quad.geometry.dispose();
      (quad.material as THREE.Material).dispose();
    }
    this.caps.length = 0;
    this.object.clear();
  }
}
