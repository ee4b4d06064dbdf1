// A gripper as boxes or cylinders in its own frame: z towards the part, x the direction of closing.
function gripper_mesh(g, width, colour) {
  const group = new THREE.Group(), tip = g.type === "parallel" ? g.pad_length / 2 : 0, top = tip - g.finger_depth;
  const solid = new THREE.MeshPhongMaterial({color: colour, specular: 0}), glass = new THREE.MeshPhongMaterial({color: colour, specular: 0, transparent: true, opacity: 0.18, depthWrite: false});
  const add = (shape, material, x, z) => { const mesh = new THREE.Mesh(shape, material); mesh.position.set(x, 0, z); group.add(mesh); return mesh; };
  if (g.type === "parallel") {
    for (const side of [-1, 1])
      add(new THREE.BoxBufferGeometry(g.finger_thickness, g.finger_width, g.finger_depth), solid, side * (width + g.finger_thickness) / 2, tip - g.finger_depth / 2);
  } else {
    const cup = Math.min(g.radius, g.finger_depth);
    add(new THREE.CylinderBufferGeometry(g.radius, g.radius / 2, cup, 24), solid, 0, -cup / 2).rotateX(Math.PI / 2);
    add(new THREE.CylinderBufferGeometry(g.radius / 2, g.radius / 2, g.finger_depth - cup, 24), solid, 0, (top - cup) / 2).rotateX(Math.PI / 2);
  }
  add(new THREE.BoxBufferGeometry(...g.palm), glass, 0, top - g.palm[2] / 2);
  return group;
}

// The best grasps, green where nearly all of friction and force is spare, red where none is. `each(grasp, colour)`.
function grasp_meshes(told, each) {
  const group = new THREE.Group();
  for (const grasp of told.grasps) {
    const colour = new THREE.Color().setHSL(0.33 * Math.min(1, grasp.score), 0.85, 0.4);
    const mesh = gripper_mesh(told.grippers.find((g) => g.name === grasp.gripper), grasp.width, colour);
    mesh.position.set(...grasp.pose.position); mesh.quaternion.set(...grasp.pose.orientation_xyzw);
    group.add(mesh);
    each(grasp, colour);
  }
  return group;
}

// How many grasps of each gripper are free, and why the others are not.
function grasp_counts(told, table) {
  const row = (texts, cell) => { const line = make("tr", "", table); texts.forEach((text, i) => { make(cell, text, line).className = i ? "n" : ""; }); };
  row(["gripper", "free", "lift blocked", "slips", "meets: approach", "closing", "lift"], "th");
  for (const c of told.counts) row([c.gripper, c.free, c.blocked, c.slips, c.approach, c.closing, c.lift], "td");
}
