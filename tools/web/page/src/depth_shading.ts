// SPDX-License-Identifier: BSD-3-Clause
// Eye-dome lighting: a pixel that lies behind its neighbours is darkened, so that walls, steps and edges of a cloud of
// points stand out without normals (C. Boucheny, "Visualisation scientifique de grands volumes de données", 2009).
import * as THREE from 'three';

const kVertex = `
varying vec2 at;
void main() {
  at = uv;
  gl_Position = vec4(position.xy, 0.0, 1.0);
}`;
const kFragment = `
uniform sampler2D colours;
uniform sampler2D depths;
uniform vec2 pixel;
uniform vec2 near_far;
uniform float strength;
uniform vec3 ground;
varying vec2 at;
float log_depth(vec2 place) {
  float z = texture2D(depths, place).r;
  float metres = near_far.x * near_far.y / (near_far.y - z * (near_far.y - near_far.x));
  return log2(metres);
}
void main() {
  if (texture2D(depths, at).r >= 1.0) {
    gl_FragColor = vec4(ground, 1.0);
    return;
  }
  float here = log_depth(at);
  float behind = 0.0;
  behind += max(0.0, here - log_depth(at + vec2(pixel.x, 0.0)));
  behind += max(0.0, here - log_depth(at - vec2(pixel.x, 0.0)));
  behind += max(0.0, here - log_depth(at + vec2(0.0, pixel.y)));
  behind += max(0.0, here - log_depth(at - vec2(0.0, pixel.y)));
  gl_FragColor = vec4(texture2D(colours, at).rgb * exp(-strength * behind), 1.0);
}`;

/** Neighbours are so many pixels of the screen away. */
const kRadiusPx = 1.4;
const kStrength = 16;

function make_target(): THREE.WebGLRenderTarget {
  return new THREE.WebGLRenderTarget(1, 1, {
    depthTexture: new THREE.DepthTexture(1, 1), minFilter: THREE.NearestFilter, magFilter: THREE.NearestFilter,
  });
}

export class DepthShading {
  private readonly pictures = [make_target(), make_target()];
  /** Which picture is shown, and into which one is drawn: the same, while it is refined before the reader's eyes. */
  private shown = 0;
  private drawn = 0;
  private readonly material = new THREE.ShaderMaterial({
    vertexShader: kVertex,
    fragmentShader: kFragment,
    depthTest: false,
    depthWrite: false,
    uniforms: {
      colours: { value: null as THREE.Texture | null },
      depths: { value: null as THREE.Texture | null },
      pixel: { value: new THREE.Vector2() },
      near_far: { value: new THREE.Vector2() },
      strength: { value: kStrength },
      ground: { value: new THREE.Vector3() },
    },
  });
  private readonly quad = new THREE.Mesh(new THREE.PlaneGeometry(2, 2), this.material);
  private readonly scene = new THREE.Scene().add(this.quad);
  private readonly flat_camera = new THREE.OrthographicCamera(-1, 1, 1, -1, 0, 1);

  constructor(private readonly renderer: THREE.WebGLRenderer) {
    this.quad.frustumCulled = false;
  }

  /** Size of the canvas in pixels of the screen. */
  resize(width_px: number, height_px: number): void {
    for (const picture of this.pictures) picture.setSize(width_px, height_px);
    const scale = kRadiusPx * Math.min(2, this.renderer.getPixelRatio());
    this.material.uniforms.pixel.value.set(scale / width_px, scale / height_px);
  }

  /** Colour where there are no points, in CSS. */
  set_ground(colour: string): void {
    const { r, g, b } = new THREE.Color(colour).getRGB({ r: 0, g: 0, b: 0 }, THREE.SRGBColorSpace);
    this.material.uniforms.ground.value.set(r, g, b);
  }

  /** Begins another picture. */
  begin(): void {
    this.drawn = 1 - this.shown;
    this.renderer.setRenderTarget(this.pictures[this.drawn]);
    this.renderer.clear();
    this.renderer.setRenderTarget(null);
  }

  /** Draws points into the picture that was begun, over those that are in it. */
  draw(points: THREE.Scene, camera: THREE.PerspectiveCamera): void {
    this.renderer.setRenderTarget(this.pictures[this.drawn]);
    this.renderer.render(points, camera);
    this.renderer.setRenderTarget(null);
  }

  /** The picture that was begun is the one that render() shows. */
  show(camera: THREE.PerspectiveCamera): void {
    this.shown = this.drawn;
    this.material.uniforms.colours.value = this.pictures[this.shown].texture;
    this.material.uniforms.depths.value = this.pictures[this.shown].depthTexture;
    this.material.uniforms.near_far.value.set(camera.near, camera.far);
  }

  /** Shows the picture on the canvas. */
  render(): void {
    this.renderer.render(this.scene, this.flat_camera);
  }
}
