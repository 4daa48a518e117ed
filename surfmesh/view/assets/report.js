// The view of a mesh in the report: colours, lines, turning, picking. One mesh, no network.
//
// Triangles are drawn without shared vertices, a curved one as `parts` flat ones, so that vertex v
// belongs to triangle v / (3 parts): the shader knows its barycentric coordinates there, and draws
// the sides and the circles of the triangle itself.
"use strict";
(async () => {
  const at = (id) => document.getElementById(id);
  const contents = JSON.parse(at("contents").textContent);
  const say = (text) => { at("message").textContent = text; at("message").hidden = !text; };

  let arrays;
  try {
    arrays = await unpacked(at("arrays").textContent);
  } catch (error) {
    say(`The mesh could not be unpacked (${error.message}); a browser from 2023 or later can.`);
    return;
  }
  at("arrays").textContent = "";
  let renderer;
  try {
    renderer = new THREE.WebGLRenderer({ canvas: at("canvas"), antialias: true });
  } catch (error) {
    say("There is no view because this browser has no WebGL 2; the rest of the page holds.");
    return;
  }

  const { points, triangles } = arrays, count = triangles.length / 3;
  const flat = arrays.facets || triangles, parts = flat.length / triangles.length || 1;
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(spread(points, 3), 3));
  const shown = new Uint8Array(3 * flat.length);
  geometry.setAttribute("colour", new THREE.BufferAttribute(shown, 3, true));
  const material = surfaceMaterial();
  const mesh = new THREE.Mesh(geometry, material);
  const scene = new THREE.Scene();
  scene.add(mesh);

  const camera = new THREE.OrthographicCamera(-1, 1, 1, -1, 0.01, 40);
  camera.up.set(0, 0, 1);
  camera.position.set(0, -10, 0);
  const controls = new THREE.OrbitControls(camera, at("canvas"));
  controls.zoomToCursor = true;
  controls.rotateSpeed = 0.9;
  controls.zoomSpeed = 1.5;
  controls.addEventListener("change", draw);

  const layers = contents.lines.map(addLines);
  addSwitches();
  addSights();
  const menu = at("by");
  contents.colourings.forEach((entry, i) => menu.add(new Option(entry.label, i)));
  menu.addEventListener("change", () => { colour(contents.colourings[menu.value]); draw(); });
  menu.value = Math.max(0, contents.colourings.findIndex((entry) => entry.key === contents.by));
  colour(contents.colourings[menu.value]);
  look(contents.sight);
  new ResizeObserver(resize).observe(at("stage"));
  resize();
  followPointer();
  for (const button of document.querySelectorAll("button[data-triangle]")) {
    button.addEventListener("click", () => visit(Number(button.dataset.triangle)));
  }
  say("");
  document.documentElement.dataset.ready = "yes";

  // ------------------------------------------------------------------ data

  async function unpacked(base64) {
    const text = atob(base64), bytes = new Uint8Array(text.length);
    for (let i = 0; i < text.length; i++) bytes[i] = text.charCodeAt(i);
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
    const whole = await new Response(stream).arrayBuffer(), found = {};
    const kinds = { f4: Float32Array, u4: Uint32Array };
    for (const { name, kind, start, length } of contents.arrays) {
      found[name] = new kinds[kind](whole, start, length);
    }
    return found;
  }

  // Values of vertices, `width` numbers each, at every corner of every flat triangle.
  function spread(values, width) {
    const out = new Float32Array(flat.length * width);
    for (let corner = 0; corner < flat.length; corner++) {
      for (let k = 0; k < width; k++) out[width * corner + k] = values[width * flat[corner] + k];
    }
    return out;
  }

  function corner(triangle, i) {
    return new THREE.Vector3().fromArray(points, 3 * triangles[3 * triangle + i]);
  }

  // ------------------------------------------------------------------ colours

  function fraction(entry, value) {
    let [low, high] = entry.limits;
    if (entry.logarithmic) [low, high, value] = [low, high, Math.max(value, low)].map(Math.log);
    return Math.min(Math.max((value - low) / (high - low), 0), 1);
  }

  function hue(entry, value) {
    const last = entry.map.length / 6 - 1;
    const k = 6 * (entry.hues ? Math.round(value) : Math.round(fraction(entry, value) * last));
    return [0, 2, 4].map((i) => parseInt(entry.map.slice(k + i, k + i + 2), 16));
  }

  function colour(entry) {
    const values = arrays[entry.array], table = new Uint8Array(entry.map.length / 2);
    for (let i = 0; i < table.length; i++) table[i] = parseInt(entry.map.slice(2 * i, 2 * i + 2), 16);
    const last = table.length / 3 - 1;
    for (let corner = 0; corner < flat.length; corner++) {
      const value = values[entry.perVertex ? flat[corner] : Math.floor(corner / (3 * parts))];
      const k = 3 * (entry.hues ? Math.round(value) : Math.round(fraction(entry, value) * last));
      shown[3 * corner] = table[k];
      shown[3 * corner + 1] = table[k + 1];
      shown[3 * corner + 2] = table[k + 2];
    }
    geometry.attributes.colour.needsUpdate = true;
    drawBar(entry);
  }

  function drawBar(entry) {
    at("bar-title").textContent = entry.title;
    const canvas = at("bar-colours"), ticks = at("bar-ticks"), [low, high] = entry.limits;
    canvas.width = entry.hues || 256;
    const paper = canvas.getContext("2d");
    for (let i = 0; i < canvas.width; i++) {
      const across = (i + 0.5) / canvas.width;
      const value = entry.logarithmic ? low * (high / low) ** across : low + (high - low) * across;
      paper.fillStyle = `rgb(${hue(entry, value).join()})`;
      paper.fillRect(i, 0, 1, 1);
    }
    ticks.replaceChildren();
    const marks = entry.hues || 5;
    for (let i = 0; i < marks; i++) {
      const across = entry.hues ? (i + 0.5) / marks : i / (marks - 1);
      const value = entry.logarithmic ? low * (high / low) ** across : low + (high - low) * across;
      const mark = document.createElement("span");
      mark.style.left = `${100 * across}%`;
      mark.textContent = entry.hues ? i : brief(value);
      ticks.append(mark);
    }
    at("bar-names").replaceChildren(...(entry.hues ? namesOfFaces(entry) : []));
  }

  // The faces that have names, each beside its colour; of many the first.
  function namesOfFaces(entry) {
    const named = contents.faceNames.map((name, face) => [name, face]);
    const found = named.filter(([name, face]) => name !== `face ${face}`).slice(0, 16);
    return found.map(([name, face]) => {
      const word = document.createElement("span"), spot = document.createElement("i");
      spot.style.background = `rgb(${hue(entry, face % entry.hues).join()})`;
      word.append(spot, ` ${face}: ${name}`);
      return word;
    });
  }

  function brief(value) {
    return value === null || !Number.isFinite(value) ? "-" : String(Number(value.toPrecision(3)));
  }

  // ------------------------------------------------------------------ the surface

  function surfaceMaterial() {
    return new THREE.ShaderMaterial({
      glslVersion: THREE.GLSL3,
      side: THREE.DoubleSide,
      polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 4,
      defines: { CORNERS: 3 * parts },
      uniforms: {
        weights: { value: new Float32Array(contents.weights) },
        sides: { value: true }, circles: { value: false }, lit: { value: false },
        picked: { value: -1 }, hovered: { value: -1 },
      },
      vertexShader: `
        in vec3 colour;
        in vec3 circle0, circle1, circle2;  // squared metric length within this triangle
        uniform vec3 weights[CORNERS];  // of the corners of a triangle
        out vec3 tint, place, weight;
        flat out vec3 around0, around1, around2;
        flat out int triangle;
        void main() {
          triangle = gl_VertexID / CORNERS;
          weight = weights[gl_VertexID % CORNERS];
          around0 = circle0; around1 = circle1; around2 = circle2;
          tint = colour;
          vec4 seen = modelViewMatrix * vec4(position, 1.0);
          place = seen.xyz;
          gl_Position = projectionMatrix * seen;
        }`,
      fragmentShader: `
        in vec3 tint, place, weight;
        flat in vec3 around0, around1, around2;
        flat in int triangle;
        uniform bool sides, circles, lit;
        uniform int picked, hovered;
        out vec4 pixel;
        // how far outside of a circle: half the metric length is on it
        float beyond(vec3 around, float s, float t) {
          return sqrt(max(around.x * s * s + around.y * t * t + 2.0 * around.z * s * t, 0.0)) - 0.5;
        }
        void main() {
          vec3 normal = normalize(cross(dFdx(place), dFdy(place)));
          float light = lit ? 0.58 + 0.42 * abs(normal.z) : 1.0;
          vec3 paint = tint;
          vec3 step = fwidth(weight);
          if (circles) {
            vec3 off = vec3(beyond(around0, weight.y, weight.z), beyond(around1, weight.z, weight.x),
                            beyond(around2, weight.x, weight.y));
            vec3 width = max(fwidth(off), 1e-6);
            vec3 rim = 1.0 - smoothstep(0.3 * width, 1.3 * width, abs(off));
            float fade = 1.0 - smoothstep(0.06, 0.25, max(width.x, max(width.y, width.z)));
            float within = 1.0 - smoothstep(0.0, 0.01, min(off.x, min(off.y, off.z)));
            paint = mix(paint, vec3(0.98, 0.80, 0.36), 0.35 * fade * within);
            paint = mix(paint, vec3(0.62, 0.24, 0.0), fade * max(rim.x, max(rim.y, rim.z)));
          }
          if (sides) {
            vec3 near = smoothstep(0.2 * step, 1.1 * step, weight);
            float fade = 1.0 - smoothstep(0.10, 0.30, max(step.x, max(step.y, step.z)));
            float line = 1.0 - min(near.x, min(near.y, near.z));
            paint = mix(paint, vec3(0.08, 0.10, 0.12), (circles ? 0.3 : 0.6) * fade * line);
          }
          if (triangle == picked) paint = mix(paint, vec3(1.0, 0.0, 0.55), 0.75);
          else if (triangle == hovered) paint = mix(paint, vec3(1.0), 0.45);
          pixel = vec4(paint * light, 1.0);
        }`,
    });
  }

  // Corner 0 of a triangle measures s e01 + t e02 by A s^2 + B t^2 + 2 C s t, in wanted lengths.
  function addCircles() {
    if (geometry.attributes.circle0) return;
    const forms = [0, 1, 2].map(() => new Float32Array(3 * flat.length));
    const e = [new THREE.Vector3(), new THREE.Vector3()];
    for (let t = 0; t < count; t++) {
      for (let i = 0; i < 3; i++) {
        const here = corner(t, i);
        e[0].subVectors(corner(t, (i + 1) % 3), here);
        e[1].subVectors(corner(t, (i + 2) % 3), here);
        for (const side of e) inWantedLengths(side, 3 * t + i);
        const form = [e[0].lengthSq(), e[1].lengthSq(), e[0].dot(e[1])];
        for (let k = 0; k < 3 * parts; k++) forms[i].set(form, 9 * parts * t + 3 * k);
      }
    }
    forms.forEach((values, i) => {
      geometry.setAttribute(`circle${i}`, new THREE.BufferAttribute(values, 3));
    });
  }

  // A step from corner c of all: by the size there, or by the six numbers of a symmetric tensor.
  function inWantedLengths(step, c) {
    if (arrays.sizes) return step.divideScalar(arrays.sizes[triangles[c]]);
    const w = arrays["inverse sizes"], k = 6 * arrays["inverse size rows"][c];
    const { x, y, z } = step;
    return step.set(w[k] * x + w[k + 1] * y + w[k + 2] * z,
                    w[k + 1] * x + w[k + 3] * y + w[k + 4] * z,
                    w[k + 2] * x + w[k + 4] * y + w[k + 5] * z);
  }

  function addLines(entry) {
    const shape = new THREE.LineSegmentsGeometry().setPositions(arrays[entry.array]);
    const paint = new THREE.LineMaterial({ color: entry.colour, linewidth: entry.width });
    const lines = new THREE.LineSegments2(shape, paint);
    lines.visible = contents.shown.includes(entry.group);
    scene.add(lines);
    return { lines, entry };
  }

  // ------------------------------------------------------------------ switches and sights

  function addSwitch(name, change, kinds = []) {
    const on = contents.shown.includes(name);
    const label = document.createElement("label"), box = document.createElement("input");
    box.type = "checkbox";
    box.checked = on;
    box.addEventListener("change", () => { change(box.checked); draw(); });
    label.append(box, ` ${name}`);
    for (const entry of kinds) {
      const word = document.createElement("b");
      word.textContent = ` ${entry.array.split(" ").pop()}`;
      word.style.color = entry.colour;
      label.append(word);
    }
    at("layers").append(label);
    change(on);
  }

  function addSwitches() {
    addSwitch("triangles", (on) => { material.uniforms.sides.value = on; });
    addSwitch("light", (on) => { material.uniforms.lit.value = on; });
    if (arrays.sizes || arrays["inverse sizes"]) {
      addSwitch("circles", (on) => { if (on) addCircles(); material.uniforms.circles.value = on; });
    }
    const groups = new Map();
    for (const { lines, entry } of layers) {
      if (!groups.has(entry.group)) groups.set(entry.group, []);
      groups.get(entry.group).push({ lines, entry });
    }
    for (const [name, members] of groups) {
      const kinds = members.length > 1 ? members.map(({ entry }) => entry) : [];
      addSwitch(name, (on) => { for (const { lines } of members) lines.visible = on; }, kinds);
    }
  }

  function addSights() {
    const sights = { fit: contents.sight, x: [1, 0, 0], y: [0, -1, 0], z: [0, -1e-4, 1] };
    for (const [name, direction] of Object.entries(sights)) {
      const button = document.createElement("button");
      button.textContent = name;
      button.title = name === "fit" ? "see the whole mesh" : `look along ${name}`;
      button.addEventListener("click", () => look(direction));
      at("sights").append(button);
    }
  }

  // See everything from a direction.
  function look(direction) {
    const towards = new THREE.Vector3(...direction).normalize();
    controls.target.set(0, 0, 0);
    camera.position.copy(towards).multiplyScalar(10);
    camera.lookAt(0, 0, 0);
    camera.updateMatrixWorld();
    const low = new THREE.Vector2(Infinity, Infinity), high = new THREE.Vector2(-Infinity, -Infinity);
    const point = new THREE.Vector3();
    for (let i = 0; i < points.length; i += 3) {
      point.fromArray(points, i).applyMatrix4(camera.matrixWorldInverse);
      low.min(point); high.max(point);
    }
    const { width, height } = stageSize();
    const unit = Math.max((high.y - low.y) / (0.94 * height), (high.x - low.x) / (0.94 * width), 1e-12);
    const middle = new THREE.Vector3((low.x + high.x) / 2, (low.y + high.y) / 2, 0);
    middle.applyQuaternion(camera.quaternion);
    controls.target.copy(middle);
    camera.position.copy(middle).addScaledVector(towards, 10);
    camera.zoom = 2 / (unit * height);
    camera.updateProjectionMatrix();
    controls.update();
    draw();
  }

  // Go near to one triangle and look at it from its front.
  function visit(triangle) {
    const [a, b, c] = [0, 1, 2].map((i) => corner(triangle, i));
    const normal = b.clone().sub(a).cross(c.clone().sub(a)).normalize();
    if (!(normal.lengthSq() > 0.5)) normal.set(...contents.sight).normalize();
    if (Math.abs(normal.z) > 0.999) normal.y -= 0.05;  // straight down has no up
    const longest = Math.max(a.distanceTo(b), b.distanceTo(c), c.distanceTo(a));
    controls.target.copy(a).add(b).add(c).divideScalar(3);
    camera.position.copy(controls.target).addScaledVector(normal.normalize(), 10);
    camera.zoom = 1 / (4 * longest);
    camera.updateProjectionMatrix();
    controls.update();
    pick(triangle);
  }

  // ------------------------------------------------------------------ picking

  function under(event) {
    const box = at("canvas").getBoundingClientRect(), ray = new THREE.Raycaster();
    const x = 2 * (event.clientX - box.left) / box.width - 1;
    const y = 1 - 2 * (event.clientY - box.top) / box.height;
    ray.setFromCamera(new THREE.Vector2(x, y), camera);
    const hit = ray.intersectObject(mesh)[0];
    return hit ? { triangle: Math.floor(hit.faceIndex / parts), point: hit.point } : null;
  }

  // What is known of a triangle: [name, value] rows.
  function known(triangle, point, entries = contents.colourings) {
    const face = arrays.face_ids[triangle], name = contents.faceNames[face];
    const rows = [["triangle", triangle], ["face", name && !name.endsWith(` ${face}`) ? `${face} (${name})` : face]];
    for (const entry of entries) {
      if (entry.hues) continue;
      const values = arrays[entry.array];
      let value = values[triangle];
      if (entry.perVertex) {
        value = 0;
        for (let i = 0; i < 3; i++) value += values[triangles[3 * triangle + i]] / 3;
      }
      rows.push([entry.title, brief(value)]);
    }
    if (point) {
      const place = point.toArray().map((x, k) => brief(x * contents.scale + contents.centre[k]));
      rows.push([`point (${contents.unit})`, place.join(", ")]);
    }
    return rows;
  }

  function pick(triangle, point) {
    material.uniforms.picked.value = triangle;
    const table = document.createElement("table");
    for (const [name, value] of known(triangle, point)) {
      const row = table.insertRow(), head = document.createElement("th");
      head.textContent = name;
      row.append(head);
      row.insertCell().textContent = value;
    }
    at("picked-text").replaceChildren(table);
    draw();
  }

  function followPointer() {
    const canvas = at("canvas"), note = at("pointer");
    let down = null, last = null, waiting = false;
    const leave = () => {
      note.hidden = true;
      last = null;
      if (material.uniforms.hovered.value !== -1) { material.uniforms.hovered.value = -1; draw(); }
    };
    canvas.addEventListener("pointerdown", (event) => { down = event; leave(); });
    canvas.addEventListener("pointerleave", leave);
    canvas.addEventListener("pointerup", (event) => {
      const still = down && Math.hypot(event.clientX - down.clientX, event.clientY - down.clientY) < 4;
      const hit = still && down.button === 0 ? under(event) : null;
      down = null;
      if (hit) pick(hit.triangle, hit.point);
    });
    canvas.addEventListener("pointermove", (event) => {
      if (event.buttons) return;
      last = event;
      if (waiting) return;
      waiting = true;
      requestAnimationFrame(() => {  // one search a picture, however fast the pointer is
        waiting = false;
        if (!last) return;
        const hit = under(last);
        if (!hit) { leave(); return; }
        const brief = (entry, i) => i === 0 || i === Number(menu.value);
        const whole = document.body.classList.contains("view");  // no table beside the view
        const entries = whole ? contents.colourings : contents.colourings.filter(brief);
        note.textContent = known(hit.triangle, null, entries).map(([name, value]) => `${name}: ${value}`).join("\n");
        note.hidden = false;
        const box = at("stage").getBoundingClientRect();
        const x = last.clientX - box.left, y = last.clientY - box.top;
        note.style.left = `${Math.min(x + 16, box.width - note.offsetWidth - 4)}px`;
        note.style.top = `${Math.min(y + 16, box.height - note.offsetHeight - 4)}px`;
        if (material.uniforms.hovered.value !== hit.triangle) {
          material.uniforms.hovered.value = hit.triangle;
          draw();
        }
      });
    });
  }

  // ------------------------------------------------------------------ drawing

  function stageSize() {
    const { clientWidth, clientHeight } = at("stage");
    return { width: Math.max(clientWidth, 1), height: Math.max(clientHeight, 1) };
  }

  function resize() {
    const { width, height } = stageSize();
    renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    renderer.setSize(width, height, false);
    camera.left = -width / height;
    camera.right = width / height;
    camera.updateProjectionMatrix();
    draw();
  }

  var asked;
  function draw() {  // at most once a picture, and only when something has changed
    if (asked) return;
    asked = requestAnimationFrame(() => {
      asked = null;
      renderer.setClearColor(0xffffff);
      renderer.render(scene, camera);
    });
  }
})();
