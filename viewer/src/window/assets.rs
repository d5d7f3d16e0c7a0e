//! Material files, and the mesh that is made of them.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use subsurf_scene::{BoundingSphere, LoadedMesh, MESH_EXTENSIONS, Mesh, SHAPES, UpAxis, load_mesh};

use super::artist::Artist;
use crate::error::{Error, Result};
use crate::file::{DrawnMaterial, material_number, parse, read, stem};
use crate::set::Set;

/// Material of a file that was found to be in order.
pub(super) struct MaterialFile {
    path: PathBuf,
    bytes: Arc<[u8]>,
    name: String,
    /// Index of the material in a BTF file; 0 otherwise.
    number: usize,
    kind: Kind,
}

/// Kind of a material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    Bssrdf,
    Btf,
    /// Kernel, and the numbers that it was made of, if those are two Gaussians.
    Kernel(Option<Artist>),
    /// Scattering precomputed for one mesh.
    Transfer,
}

impl MaterialFile {
    /// The material of a file; of a BTF all of its materials, or the one that is asked for by name or number.
    pub(super) fn open(path: &Path, asked: Option<&str>) -> Result<Vec<Arc<Self>>> {
        let bytes: Arc<[u8]> = read(path)?.into();
        let one = |name: String, number, kind| {
            Arc::new(Self { path: path.to_owned(), bytes: bytes.clone(), name, number, kind })
        };
        match parse(path, &bytes)? {
            DrawnMaterial::Bssrdf(_) => Ok(vec![one(stem(path), 0, Kind::Bssrdf)]),
            DrawnMaterial::Kernel(kernel) => Ok(vec![one(stem(path), 0, Kind::Kernel(Artist::of(&kernel)))]),
            DrawnMaterial::Transfer(_) => Ok(vec![one(stem(path), 0, Kind::Transfer)]),
            DrawnMaterial::Btf(btf) => {
                let names: Vec<String> = btf.materials().map(|material| material.name().to_owned()).collect();
                let of = |number: usize| match &names[..] {
                    [_] => one(stem(path), number, Kind::Btf),
                    names => one(format!("{} {}", stem(path), names[number]), number, Kind::Btf),
                };
                let Some(asked) = asked else {
                    return Ok((0..names.len()).map(of).collect());
                };
                let number = material_number(&names, asked).ok_or_else(|| {
                    let last = names.len().saturating_sub(1);
                    Error::Request(format!("no material {asked}: the file has {}, and 0 to {last}", names.join(", ")))
                })?;
                Ok(vec![of(number)])
            }
        }
    }

    pub(super) fn name(&self) -> String {
        self.name.clone()
    }

    pub(super) fn number(&self) -> usize {
        self.number
    }

    pub(super) fn kind(&self) -> Kind {
        self.kind
    }

    pub(super) fn read(&self) -> Result<DrawnMaterial<'_>> {
        parse(&self.path, &self.bytes)
    }
}

/// How mesh files are read: to which size, which way is up in them, and what they stand in.
#[derive(Clone, Copy, Debug)]
pub(super) struct MeshReading {
    pub(super) set: Set,
    pub(super) extent_mm: f32,
    pub(super) up: UpAxis,
}

/// Materials to choose from, and the mesh that is made of one of them.
pub(super) struct Assets {
    pub(super) materials: Vec<Arc<MaterialFile>>,
    /// Mesh with the ground of the set.
    pub(super) mesh: Arc<Mesh>,
    /// Sphere around the mesh without ground.
    pub(super) bounds: BoundingSphere,
    /// What was changed or left out of the mesh's file.
    pub(super) warnings: Vec<String>,
    pub(super) mesh_name: String,
    /// Count of the meshes so far: a number for each.
    pub(super) mesh_number: u32,
    reading: MeshReading,
}

/// Kind of a file that was dropped onto the window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Dropped {
    /// The material of this number.
    Material(usize),
    Mesh,
}

impl Assets {
    /// Opens material files and a mesh; `asked` is the one material of BTF files that is wanted.
    pub(super) fn open(materials: &[PathBuf], asked: Option<&str>, mesh: &Path, reading: MeshReading) -> Result<Self> {
        let open = |path: &PathBuf| MaterialFile::open(path, asked);
        let files = materials.iter().map(open).collect::<Result<Vec<_>>>()?;
        let loaded = load_mesh(mesh, reading.extent_mm, reading.up)?;
        Ok(Self {
            materials: files.concat(),
            bounds: loaded.mesh.bounding_sphere(),
            mesh: Arc::new(reading.set.with_ground(&loaded.mesh).into_owned()),
            warnings: loaded.warnings,
            mesh_name: stem(mesh),
            mesh_number: 0,
            reading,
        })
    }

    /// Opens a file that was dropped onto the window. If it fails, everything stays as it was.
    pub(super) fn drop(&mut self, path: &Path) -> Result<Dropped> {
        let extension = path.extension().map_or_else(String::new, |text| text.to_string_lossy().to_ascii_lowercase());
        match extension.as_str() {
            "subsurf" => {
                let first = self.materials.len();
                // The material that was asked for is one of other files. The same file again replaces nothing: it may have
                // been encoded anew.
                let files = MaterialFile::open(path, None)?;
                self.materials.extend(files);
                Ok(Dropped::Material(first))
            }
            extension if MESH_EXTENSIONS.contains(&extension) => {
                self.set_mesh(path)?;
                Ok(Dropped::Mesh)
            }
            _ => Err(Error::Request(format!(
                "{}: neither a material (.subsurf) nor a mesh (.{}); drop one of these",
                path.display(),
                MESH_EXTENSIONS.join(", .")
            ))),
        }
    }

    /// The shape after this one; the first where the mesh is from a file.
    pub(super) fn next_shape(&mut self) -> Result<()> {
        let next = SHAPES.iter().position(|name| *name == self.mesh_name).map_or(0, |at| (at + 1) % SHAPES.len());
        self.set_mesh(Path::new(SHAPES[next]))
    }

    fn set_mesh(&mut self, path: &Path) -> Result<()> {
        let LoadedMesh { mesh, warnings } = load_mesh(path, self.reading.extent_mm, self.reading.up)?;
        (self.bounds, self.warnings) = (mesh.bounding_sphere(), warnings);
        self.mesh = Arc::new(self.reading.set.with_ground(&mesh).into_owned());
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
        let reading = MeshReading { set: Set::Studio, extent_mm: 60.0, up: UpAxis::Y };
        let mut assets = Assets::open(&[], None, Path::new("torus"), reading).unwrap();
        let triangle = file("triangle.OBJ", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
        assert_eq!(assets.drop(&triangle).unwrap(), Dropped::Mesh);
        assert_eq!((assets.mesh_name.as_str(), assets.mesh_number, assets.mesh.triangles.len()), ("triangle", 1, 1));
        for (name, text, reason) in [
            ("broken.subsurf", "no material", "broken.subsurf"),
            ("broken.obj", "v 0 0", "broken.obj"),
            ("notes.txt", "hello", "drop one of these"),
        ] {
            let error = assets.drop(&file(name, text)).unwrap_err();
            assert!(format!("{error:#}").contains(reason), "{error:#}");
        }
        assert_eq!((assets.mesh_name.as_str(), assets.materials.len()), ("triangle", 0), "as before");
        assets.next_shape().unwrap();
        assert_eq!(assets.mesh_name, SHAPES[0]);
    }
}
