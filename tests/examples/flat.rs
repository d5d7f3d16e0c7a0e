//! Scratch.
use std::time::Instant;
use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::Addressing;
use subsurf_encoder::synthetic::Shape;
use subsurf_runtime::*;
use subsurf_shaders::separable::{Detail, Factors, mean_kernel};
fn main() {
    for backend in Backend::ALL {
        let gpu = Gpu::open(backend).unwrap();
        for side in [96u32, 256, 512] {
            let file = Shape { size: [side; 2], radius: 12, samples: 13, base_materials: 128, addressing: Addressing::Clamp }.bmpp();
            let m = Bssrdf::parse(&file).unwrap();
            let e = vec![[1.0; 3]; (side * side) as usize];
            let light = PatchLight::upload(&gpu, [side; 2], &e).unwrap();
            let up = Material::upload(&gpu, &m).unwrap();
            let g = PatchRenderer::new(&gpu, storage_of(&m)).unwrap();
            let f = Factors::of(&m, Detail::default());
            let sm = SeparableMaterial::upload(&gpu, &f).unwrap();
            let s = SeparableRenderer::new(&gpu, 2).unwrap();
            let sp = s.prepare(&gpu, &sm, &light).unwrap();
            let h = HomogeneousRenderer::new(&gpu).unwrap();
            let hp = h.prepare(&gpu, m.header(), &mean_kernel(&m), &light).unwrap();
            gpu.finish().unwrap();
            let time = |n: usize, f: &dyn Fn()| {
                f(); gpu.finish().unwrap();
                let mut v: Vec<f64> = (0..n).map(|_| { let t = Instant::now(); f(); gpu.finish().unwrap(); t.elapsed().as_secs_f64() * 1e3 }).collect();
                v.sort_by(f64::total_cmp); v[n / 2]
            };
            let region = Region { origin: [0, 0], size: [side; 2] };
            let tg = time(5, &|| { g.gather(&gpu, &up, &light, region).unwrap(); });
            let ts = time(15, &|| { s.draw(&gpu, &sp).unwrap(); });
            let th = time(15, &|| { h.draw(&gpu, &hp).unwrap(); });
            println!("{backend} {side}: gather {tg:.1} separable {ts:.2} homogeneous {th:.2} ms; {:.1}x faster, {:.2}x homogeneous; sigmas {:?}", tg / ts, ts / th, f.sigmas);
        }
    }
}
