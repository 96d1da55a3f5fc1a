// drc2obj.js PACKAGE_DIR FILE.drc: decodes a Draco mesh with the draco3d package and prints it as OBJ.
'use strict';
const fs = require('fs');
const path = require('path');
const [packageDir, file] = process.argv.slice(2);

require(path.resolve(packageDir)).createDecoderModule({}).then((draco) => {
  const bytes = fs.readFileSync(file);
  const input = new draco.DecoderBuffer();
  input.Init(new Int8Array(bytes), bytes.length);
  const decoder = new draco.Decoder();
  const mesh = new draco.Mesh();
  const status = decoder.DecodeBufferToMesh(input, mesh);
  if (!status.ok()) throw new Error(status.error_msg());

  const positions = new draco.DracoFloat32Array();
  const attribute = decoder.GetAttribute(mesh, decoder.GetAttributeId(mesh, draco.POSITION));
  decoder.GetAttributeFloatForAllPoints(mesh, attribute, positions);
  const lines = [];
  for (let v = 0; v < mesh.num_points(); v++) {
    lines.push(`v ${positions.GetValue(3 * v)} ${positions.GetValue(3 * v + 1)} ${positions.GetValue(3 * v + 2)}`);
  }
  const corners = new draco.DracoInt32Array();
  for (let f = 0; f < mesh.num_faces(); f++) {
    decoder.GetFaceFromMesh(mesh, f, corners);
    lines.push(`f ${corners.GetValue(0) + 1} ${corners.GetValue(1) + 1} ${corners.GetValue(2) + 1}`);
  }
  fs.writeFileSync(1, lines.join('\n') + '\n');
}).catch((error) => {
  console.error(`drc2obj: ${error.message}`);
  process.exitCode = 1;
});
