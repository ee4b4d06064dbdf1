// The STEP files of test/mesh/cad_test.cpp, read by the package occt-import-js: the same size, volume and area.
//     step_test.js TOOL CAD_TEST
const assert = require("node:assert/strict");
const { execFileSync, spawnSync } = require("node:child_process");
const fs = require("node:fs");
const os = require("node:os");
const path = require("node:path");
const { after, test } = require("node:test");

const occt_import = require("occt-import-js");

const [tool, cad_test] = process.argv.slice(2);
const work = fs.mkdtempSync(path.join(os.tmpdir(), "bin_scenes_step_"));
after(() => fs.rmSync(work, { recursive: true }));

const chord = 1e-4, angle = 0.3;   // m, rad: of both readers

/** Volume (m3), area (m2) and corners (m) of all meshes together. */
function measures(meshes) {
  const sum = { volume: 0, area: 0, lower: [Infinity, Infinity, Infinity], upper: [-Infinity, -Infinity, -Infinity] };
  for (const mesh of meshes) {
    const points = mesh.attributes.position.array;
    const point = (i) => [points[3 * i], points[3 * i + 1], points[3 * i + 2]];
    for (let t = 0; t < mesh.index.array.length; t += 3) {
      const [a, b, c] = mesh.index.array.slice(t, t + 3).map(point);
      const u = b.map((x, k) => x - a[k]), v = c.map((x, k) => x - a[k]);
      const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
      sum.volume += (a[0] * n[0] + a[1] * n[1] + a[2] * n[2]) / 6;
      sum.area += Math.hypot(...n) / 2;
      for (const corner of [a, b, c])
        for (let k = 0; k < 3; ++k) {
          sum.lower[k] = Math.min(sum.lower[k], corner[k]);
          sum.upper[k] = Math.max(sum.upper[k], corner[k]);
        }
    }
  }
  return sum;
}

function near(a, b, tolerance, what) {
  assert.ok(Math.abs(a - b) <= tolerance, `${what}: ${a} here, ${b} there`);
}

test("another reader finds the same solids", async () => {
  const occt = await occt_import();
  execFileSync(cad_test, ["--gtest_filter=Cad.ABox*:Cad.Curved*:Cad.SolidsThatTouch*"],
               { env: { ...process.env, CAD_TEST_KEEP: work }, stdio: "pipe" });
  const files = fs.readdirSync(work).sort();
  let compared = 0;
  for (const name of files) {
    const inspected = spawnSync(tool, ["inspect", name, "--json", "--chord", String(chord), "--angle", String(angle)],
                                { cwd: work, env: { ...process.env, BIN_SCENES_CACHE: path.join(work, "cache") } });
    const several = name.endsWith("_assembly.stp");
    if (inspected.status === 2 && several) continue;  // its solids do not touch
    assert.equal(inspected.status, 0, String(inspected.stderr));
    const ours = JSON.parse(inspected.stdout);
    const read = occt.ReadStepFile(fs.readFileSync(path.join(work, name)),
                                   { linearUnit: "meter", linearDeflectionType: "absolute_value", linearDeflection: chord,
                                     angularDeflection: angle });
    assert.ok(read.success, name);
    const theirs = measures(read.meshes);
    near(ours.mass_properties.volume, theirs.volume, 1e-3 * theirs.volume, `${name}: volume`);
    // Of solids that touch, theirs has the walls between them.
    if (!several) near(ours.mass_properties.area, theirs.area, 1e-3 * theirs.area, `${name}: area`);
    for (let k = 0; k < 3; ++k) {
      near(ours.lower[k], theirs.lower[k], 2 * chord, `${name}: lower[${k}]`);
      near(ours.size[k], theirs.upper[k] - theirs.lower[k], 4 * chord, `${name}: size[${k}]`);
    }
    console.log(`${name}: ${ours.triangles} triangles, volume ${ours.mass_properties.volume} and ${theirs.volume}, area ` +
                `${ours.mass_properties.area} and ${theirs.area}`);
    ++compared;
  }
  assert.equal(files.length, 14);
  assert.equal(compared, 13);
});
