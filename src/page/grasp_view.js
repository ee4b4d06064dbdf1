// A gripper as boxes or cylinders in its own frame: z towards the part, x the direction of closing. Fingers that press
// from within are between the surfaces that they touch.
function gripper_mesh(g, width, colour, inner) {
  const group = new THREE.Group(), tip = g.type === "parallel" ? g.pad_length / 2 : 0, top = tip - g.finger_depth;
  const solid = new THREE.MeshPhongMaterial({color: colour, specular: 0}), glass = new THREE.MeshPhongMaterial({color: colour, specular: 0, transparent: true, opacity: 0.18, depthWrite: false});
  const add = (shape, material, x, z, y = 0) => { const mesh = new THREE.Mesh(shape, material); mesh.position.set(x, y, z); group.add(mesh); return mesh; };
  if (g.type === "parallel") {
    // Boxes of the finger at +x, closed; files of earlier versions have none.
    const boxes = g.finger_boxes || [[[0, -g.finger_width / 2, top], [g.finger_thickness, g.finger_width / 2, tip]]];
    const face = width / 2 - (inner ? g.finger_thickness : 0);
    for (const [lower, upper] of boxes) {
      const [x, y, z] = lower.map((value, k) => (value + upper[k]) / 2), size = lower.map((value, k) => upper[k] - value);
      for (const side of [-1, 1]) add(new THREE.BoxBufferGeometry(...size), solid, side * (face + x), z, side * y);
    }
  } else {
    const cup = Math.min(g.radius, g.finger_depth);
    add(new THREE.CylinderBufferGeometry(g.radius, g.radius / 2, cup, 24), solid, 0, -cup / 2).rotateX(Math.PI / 2);
    add(new THREE.CylinderBufferGeometry(g.radius / 2, g.radius / 2, g.finger_depth - cup, 24), solid, 0, (top - cup) / 2).rotateX(Math.PI / 2);
  }
  const flange = new THREE.Quaternion().setFromEuler(new THREE.Euler(...(g.tool_rotation || [0, 0, 0]), "ZYX")).conjugate();
  const palm = add(new THREE.BoxBufferGeometry(...g.palm), glass, 0, 0);
  palm.quaternion.copy(flange);
  palm.position.set(0, 0, top).add(new THREE.Vector3(0, 0, -g.palm[2] / 2).applyQuaternion(flange));
  return group;
}

// The best grasps, green where nearly all of friction and force is spare, red where none is. `each(grasp, colour)`.
function grasp_meshes(view, each) {
  const group = new THREE.Group();
  for (const grasp of view.grasps) {
    const colour = new THREE.Color().setHSL(0.33 * Math.min(1, grasp.score), 0.85, 0.4);
    const mesh = gripper_mesh(view.grippers.find((g) => g.name === grasp.gripper), grasp.width, colour, grasp.inner);
    mesh.position.set(...grasp.pose.position); mesh.quaternion.set(...grasp.pose.orientation_xyzw);
    group.add(mesh);
    each(grasp, colour);
  }
  return group;
}

// How many grasps of each gripper are free, and why the others are not: a paragraph each, which fits a panel of any width.
function grasp_counts(view, place) {
  const fates = [["lift blocked", "blocked"], ["slips", "slips"], ["meets something on its approach", "approach"], ["as it closes", "closing"], ["during the lift", "lift"]];
  for (const c of view.counts) {
    const line = make("p", "", place), all = c.free + fates.reduce((sum, [, key]) => sum + c[key], 0);
    make("b", c.gripper, line);
    line.append(`: ${c.free} of ${all} grasps are free; ` + fates.filter(([, key]) => c[key]).map(([text, key]) => `${text} ${c[key]}`).join(", "));
  }
}
