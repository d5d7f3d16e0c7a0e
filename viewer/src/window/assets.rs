//! What is looked at: material files, and a mesh.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use subsurf_runtime::scene::Mesh;

use crate::failure::bad_request;
use crate::info::{Parsed, parse_any, read_file};
use crate::mesh::{SHAPES, Up, load, stem};
use crate::render::BtfArgs;

/// A material file that was found to be in order.
pub(super) struct MaterialFile {
    path: PathBuf,
    bytes: Arc<[u8]>,
    name: String,
    /// Which material of a BTF.
    number: usize,
    is_btf: bool,
}

impl MaterialFile {
    /// The material of a file; of a BTF all of its materials, or the one that is asked for.
    pub(super) fn open(path: &Path, btf_args: &BtfArgs) -> anyhow::Result<Vec<Arc<Self>>> {
        let bytes: Arc<[u8]> = read_file(path)?.into();
        let one = |name: String, number, is_btf| {
            Arc::new(Self { path: path.to_owned(), bytes: bytes.clone(), name, number, is_btf })
        };
        match parse_any(path, &bytes)? {
            Parsed::Bssrdf(_) => Ok(vec![one(stem(path), 0, false)]),
            Parsed::Btf(btf) => {
                let names: Vec<String> = btf.materials().map(|material| material.name().to_owned()).collect();
                let of = |number: usize| match &names[..] {
                    [_] => one(stem(path), number, true),
                    names => one(format!("{} {}", stem(path), names[number]), number, true),
                };
                Ok(match btf_args.material {
                    Some(_) => vec![of(btf_args.number(&btf)?)],
                    None => (0..names.len()).map(of).collect(),
                })
            }
        }
    }

    pub(super) fn name(&self) -> String {
        self.name.clone()
    }

    pub(super) fn number(&self) -> usize {
        self.number
    }

    pub(super) fn is_btf(&self) -> bool {
        self.is_btf
    }

    pub(super) fn read(&self) -> anyhow::Result<Parsed<'_>> {
        parse_any(&self.path, &self.bytes)
    }
}

/// How meshes are read.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reading {
    pub(super) extent_mm: f32,
    pub(super) up: Up,
}

/// Materials to choose from, and the mesh that is made of one of them.
pub(super) struct Subject {
    pub(super) materials: Vec<Arc<MaterialFile>>,
    pub(super) mesh: Arc<Mesh>,
    pub(super) mesh_name: String,
    /// Tells meshes apart.
    pub(super) mesh_number: u32,
    pub(super) btf: Arc<BtfArgs>,
    reading: Reading,
}

/// What a file on the window turned out to be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Dropped {
    /// The material of this number.
    Material(usize),
    Mesh,
}

impl Subject {
    pub(super) fn open(
        materials: &[PathBuf],
        mesh: &Path,
        reading: Reading,
        btf: &Arc<BtfArgs>,
    ) -> anyhow::Result<Self> {
        let open = |path: &PathBuf| MaterialFile::open(path, btf);
        let files = materials.iter().map(open).collect::<anyhow::Result<Vec<_>>>()?;
        Ok(Self {
            materials: files.concat(),
            btf: btf.clone(),
            mesh: Arc::new(load(mesh, reading.extent_mm, reading.up)?),
            mesh_name: stem(mesh),
            mesh_number: 0,
            reading,
        })
    }

    /// Opens a file that was dropped onto the window. If it fails, everything stays as it was.
    pub(super) fn drop(&mut self, path: &Path) -> anyhow::Result<Dropped> {
        let extension = path.extension().map_or_else(String::new, |text| text.to_string_lossy().to_ascii_lowercase());
        match extension.as_str() {
            "subsurf" => {
                let first = self.materials.len();
                // What was asked for on the command line was of other files. The same file again replaces nothing: it may
                // have been encoded anew.
                let files = MaterialFile::open(path, &BtfArgs::default())?;
                self.materials.extend(files);
                Ok(Dropped::Material(first))
            }
            "obj" | "ply" | "glb" | "gltf" => {
                self.set_mesh(path)?;
                Ok(Dropped::Mesh)
            }
            _ => Err(bad_request(format!(
                "{}: neither a material (.subsurf) nor a mesh (.obj, .ply, .glb, .gltf); drop one of these",
                path.display()
            ))),
        }
    }

    /// The shape after this one; the first where the mesh is from a file.
    pub(super) fn next_shape(&mut self) -> anyhow::Result<()> {
        let next = SHAPES.iter().position(|name| *name == self.mesh_name).map_or(0, |at| (at + 1) % SHAPES.len());
        self.set_mesh(Path::new(SHAPES[next]))
    }

    fn set_mesh(&mut self, path: &Path) -> anyhow::Result<()> {
        self.mesh = Arc::new(load(path, self.reading.extent_mm, self.reading.up)?);
        self.mesh_name = stem(path);
        self.mesh_number += 1;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_dropped_is_opened_or_refused_and_nothing_is_lost() {
        let folder = tempfile::tempdir().unwrap();
        let file = |name: &str, text: &str| {
            let path = folder.path().join(name);
            std::fs::write(&path, text).unwrap();
            path
        };
        let reading = Reading { extent_mm: 60.0, up: Up::Y };
        let mut subject = Subject::open(&[], Path::new("torus"), reading, &Arc::default()).unwrap();
        let triangle = file("triangle.OBJ", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
        assert_eq!(subject.drop(&triangle).unwrap(), Dropped::Mesh);
        assert_eq!((subject.mesh_name.as_str(), subject.mesh_number, subject.mesh.triangles.len()), ("triangle", 1, 1));
        for (name, text, reason) in [
            ("broken.subsurf", "no material", "broken.subsurf"),
            ("broken.obj", "v 0 0", "broken.obj"),
            ("notes.txt", "hello", "drop one of these"),
        ] {
            let error = subject.drop(&file(name, text)).unwrap_err();
            assert!(format!("{error:#}").contains(reason), "{error:#}");
        }
        assert_eq!((subject.mesh_name.as_str(), subject.materials.len()), ("triangle", 0), "as before");
        subject.next_shape().unwrap();
        assert_eq!(subject.mesh_name, SHAPES[0]);
    }
}
