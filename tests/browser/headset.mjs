// SPDX-License-Identifier: Apache-2.0
// A headset that a page may believe in, as much of WebXR as is asked of one: two eyes 64 mm apart,
// and controllers that tests push about.

/** Runs in the page, before its scripts. */
export function makeHeadset() {
  const translated = (x, y, z) => [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, y, z, 1]
  const at = (matrix) => ({ matrix: new Float32Array(matrix) })
  // 90 degrees each way, from 0.1 to 100 m.
  const projection = new Float32Array([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1.002, -1, 0, 0, -0.2002, 0])
  const headset = { head: [0, 1.6, 0], sources: [], frames: 0, asked: undefined }
  const frame = {
    getViewerPose: () => ({ transform: at(translated(...headset.head)), views: [-0.032, 0.032].map((x) => (
      { eye: x < 0 ? 'left' : 'right', projectionMatrix: projection, transform: at(translated(headset.head[0] + x, headset.head[1], headset.head[2])) })) }),
    // The space of a ray is its matrix.
    getPose: (space) => ({ transform: at(space) }),
  }
  class Session extends EventTarget {
    enabledFeatures = []
    renderState = {}
    visibilityState = 'visible'
    environmentBlendMode = 'opaque'
    get inputSources() { return headset.sources }
    updateRenderState(state) { Object.assign(this.renderState, state) }
    async requestReferenceSpace(kind) { return { kind } }
    requestAnimationFrame(draw) {
      return window.requestAnimationFrame((now) => {
        if (this.over) return
        ++headset.frames
        draw(now, Object.assign(frame, { session: this }))
      })
    }
    cancelAnimationFrame(id) { window.cancelAnimationFrame(id) }
    async end() {
      this.over = true
      this.dispatchEvent(new Event('end'))
    }
  }
  headset.tell = (name, inputSource) => headset.session.dispatchEvent(Object.assign(new Event(name), { inputSource }))
  Object.defineProperty(window, 'XRWebGLBinding', { value: undefined })
  WebGL2RenderingContext.prototype.makeXRCompatible = async () => {}
  window.XRWebGLLayer = class {
    framebuffer = null
    framebufferWidth = 400
    framebufferHeight = 200
    getViewport({ eye }) { return { x: eye === 'left' ? 0 : 200, y: 0, width: 200, height: 200 } }
  }
  Object.defineProperty(navigator, 'xr', { value: {
    isSessionSupported: async (mode) => mode === 'immersive-vr',
    requestSession: async (mode, wishes) => {
      headset.asked = { mode, wishes }
      return (headset.session = new Session())
    },
  } })
  window.headset = headset
}
