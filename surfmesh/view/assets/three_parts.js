// What the viewer takes from three.js; bundled once into three.min.js, see README.md here.
export {
  BufferAttribute, BufferGeometry, Color, DoubleSide, GLSL3, Mesh, OrthographicCamera, Raycaster,
  Scene, ShaderMaterial, Vector2, Vector3, WebGLRenderer,
} from "three";
export { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
export { LineMaterial } from "three/examples/jsm/lines/LineMaterial.js";
export { LineSegments2 } from "three/examples/jsm/lines/LineSegments2.js";
export { LineSegmentsGeometry } from "three/examples/jsm/lines/LineSegmentsGeometry.js";
