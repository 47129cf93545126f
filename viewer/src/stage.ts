// SPDX-License-Identifier: Apache-2.0
// The canvas: draws the lit mesh and what is laid over it, and measures what it drew.

import * as THREE from 'three'
import { LitMesh } from './lit_mesh'
import { applyPose, type Pose } from './pose'
import { type Look, LOOKS, lookUniforms, type LookUniforms } from './shading'
import type { Solution } from './solution'
import { automaticExposure, TONE_CURVES, type ToneCurve, whiteOf } from './tone'

// Sides of a picture [pixels]: what browsers hold in one canvas. It is drawn in tiles, each within what graphics
// cards draw at once.
export const LEAST_PICTURE = 16, MOST_PICTURE = 16384
const MOST_TILE = 2048

export class Stage {
  readonly renderer: THREE.WebGLRenderer
  readonly camera = new THREE.PerspectiveCamera(45, 1, 0.01, 100)
  readonly scene = new THREE.Scene()
  /** What carries the camera: at rest, but where a headset moves the eyes. */
  readonly rig = new THREE.Group()
  /** Grids, tape and the like; not measured, not exposed for. */
  readonly overlay = new THREE.Group()
  mesh!: LitMesh
  uniforms!: LookUniforms
  /** The section, for what three.js shades; what the page shades itself has it in the uniforms. */
  readonly cut: THREE.Plane[] = []
  private columns: 'exitance' | 'irradiance' | 'unshot' = 'exitance'
  private meter = new THREE.WebGLRenderTarget(96, 54, { type: THREE.FloatType, depthBuffer: true })
  private eye = new THREE.WebGLRenderTarget(1, 1, { type: THREE.FloatType, depthBuffer: true })

  constructor(readonly canvas: HTMLCanvasElement) {
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, powerPreference: 'high-performance' })
    this.renderer.xr.enabled = true
    this.renderer.localClippingEnabled = true
    this.rig.add(this.camera)
    this.scene.add(this.overlay, this.rig)
  }

  async show(solution: Solution): Promise<void> {
    if (this.mesh?.continueWith(solution)) return
    const uniforms = lookUniforms(LitMesh.columnsOf(solution), solution.groups.length)
    if (this.uniforms)
      for (const name of Object.keys(uniforms))
        if (!['factors', 'groupFactors', 'restFactors'].includes(name)) uniforms[name] = this.uniforms[name]
    const mesh = await LitMesh.make(solution, uniforms)
    if (this.mesh) {
      this.scene.remove(this.mesh)
      this.mesh.dispose()
    }
    this.mesh = mesh
    this.uniforms = uniforms
    this.scene.add(mesh)
  }

  /** Contours are of illuminance, but of what is shown in false colours. */
  setLook(look: Look, contours: boolean): void {
    this.uniforms.look.value = LOOKS.indexOf(look)
    this.columns = look === 'unshot' ? 'unshot' : look === 'illuminance' || (contours && look !== 'exitance') ? 'irradiance' : 'exitance'
    this.mesh.showColumns(this.columns)
  }
  /** Shows what lies where dot(xyz, p) <= w, in the page's frame; everything if xyz is 0. */
  setSection(section: THREE.Vector4): void {
    this.uniforms.section.value.copy(section)
    const { x, y, z, w } = section
    this.cut.splice(0, 1, ...(x || y || z ? [new THREE.Plane(new THREE.Vector3(-x, -y, -z), w)] : []))
  }
  setToneCurve(curve: ToneCurve): void {
    this.uniforms.toneCurve.value = TONE_CURVES.indexOf(curve)
  }

  resize(): boolean {
    if (this.renderer.xr.isPresenting) return false
    const { clientWidth: width, clientHeight: height } = this.canvas
    const ratio = Math.min(devicePixelRatio, 2)
    const size = this.renderer.getSize(new THREE.Vector2())
    if (size.x === width && size.y === height && this.renderer.getPixelRatio() === ratio) return false
    this.renderer.setPixelRatio(ratio)
    this.renderer.setSize(width, height, false)
    return true
  }

  private aim(pose: Pose, aspect: number): void {
    // As tight as it goes: lamps hang a tenth of a millimetre below ceilings.
    const box = this.mesh.geometry.boundingBox!, reach = box.getSize(new THREE.Vector3()).length()
    const eye = pose.eye.clone().applyQuaternion(this.mesh.quaternion.clone().invert())
    const outside = box.distanceToPoint(eye)
    this.camera.aspect = aspect
    this.camera.near = Math.max(2e-3 * reach, 0.7 * outside)
    this.camera.far = 1.01 * (outside + reach) + this.camera.near
    applyPose(pose, this.camera)
  }

  draw(pose: Pose): void {
    if (!this.renderer.xr.isPresenting) this.aim(pose, this.canvas.clientWidth / Math.max(1, this.canvas.clientHeight))
    this.renderer.render(this.scene, this.camera)
  }

  /** RGB radiance and coverage as they reach the eye, without tone mapping. */
  private measure(target: THREE.WebGLRenderTarget): Float32Array {
    const pixels = new Float32Array(4 * target.width * target.height)
    const colour = this.renderer.getClearColor(new THREE.Color()), alpha = this.renderer.getClearAlpha()
    const xr = this.renderer.xr.enabled
    this.renderer.xr.enabled = false
    this.renderer.setClearColor(0, 0)
    this.uniforms.raw.value = true
    this.overlay.visible = false
    this.mesh.linesVisible = false
    this.mesh.showColumns('exitance')
    this.renderer.setRenderTarget(target)
    this.renderer.render(this.scene, this.camera)
    this.renderer.readRenderTargetPixels(target, 0, 0, target.width, target.height, pixels)
    this.renderer.setRenderTarget(null)
    this.overlay.visible = true
    this.mesh.linesVisible = true
    this.mesh.showColumns(this.columns)
    this.uniforms.raw.value = false
    this.renderer.setClearColor(colour, alpha)
    this.renderer.xr.enabled = xr
    return pixels
  }

  /** Exposure that suits what is seen, or the given one, and the white that goes with it. */
  expose(pose: Pose, given?: number): { exposure: number; white: number } {
    this.aim(pose, this.canvas.clientWidth / Math.max(1, this.canvas.clientHeight))
    const pixels = this.measure(this.meter)
    const exposure = given ?? automaticExposure(pixels)
    return { exposure, white: whiteOf(pixels, exposure) }
  }

  /** Linear RGB radiance of one pixel of the canvas [CSS pixels]. */
  radianceAt(pose: Pose, x: number, y: number): [number, number, number] {
    const { clientWidth: width, clientHeight: height } = this.canvas
    this.aim(pose, width / height)
    this.camera.setViewOffset(width, height, Math.floor(x), Math.floor(y), 1, 1)
    const pixel = this.measure(this.eye)
    this.camera.clearViewOffset()
    return [pixel[0], pixel[1], pixel[2]]
  }

  /** From the eye through a place on the canvas [CSS pixels]. */
  ray(pose: Pose, x: number, y: number): THREE.Ray {
    const { clientWidth: width, clientHeight: height } = this.canvas
    this.aim(pose, width / Math.max(1, height))
    const caster = new THREE.Raycaster()
    caster.setFromCamera(new THREE.Vector2(2 * x / width - 1, 1 - 2 * y / height), this.camera)
    return caster.ray
  }

  /** A picture of any size as PNG. `drawn` follows each tile with the share that is done: it draws the page again,
   * where the tile was drawn. */
  async picture(pose: Pose, width: number, height: number, drawn: (share: number) => void): Promise<Blob> {
    const sheet = document.createElement('canvas')
    sheet.width = width
    sheet.height = height
    const context = sheet.getContext('2d')
    for (let y = 0; context && y < height; y += MOST_TILE)
      for (let x = 0; x < width; x += MOST_TILE) {
        if (x + y > 0) await new Promise((resolve) => setTimeout(resolve))  // the page goes on meanwhile
        const w = Math.min(MOST_TILE, width - x), h = Math.min(MOST_TILE, height - y)
        this.drawTile(pose, width, height, x, y, w, h)
        context.drawImage(this.canvas, x, y)
        this.resize()
        drawn((y * width + h * (x + w)) / (width * height))
      }
    const blob = await new Promise<Blob | null>((done) => sheet.toBlob(done, 'image/png'))
    if (!blob) throw Error(`A picture of ${width} × ${height} pixels is more than this browser can make.`)
    return blob
  }

  /** A part of a picture, on the page's own canvas. */
  private drawTile(pose: Pose, width: number, height: number, x: number, y: number, w: number, h: number): void {
    this.renderer.setPixelRatio(1)
    this.renderer.setSize(w, h, false)
    this.aim(pose, width / height)
    this.camera.setViewOffset(width, height, x, y, w, h)
    this.renderer.render(this.scene, this.camera)
    this.camera.clearViewOffset()
  }
}
