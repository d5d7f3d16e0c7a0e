//! tmp
use subsurf_encoder::bssrdf::*;
use subsurf_encoder::capture::*;
use subsurf_encoder::metrics::*;
use subsurf_encoder::*;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let cap = Capture::open(std::path::Path::new(&a[1]), &Overrides::default()).unwrap();
    let s = a.get(2).and_then(|s| s.parse().ok());
    for m in [Method::Lsp, Method::Clusters, Method::Direct] {
        let t = std::time::Instant::now();
        let e = encode(
            &cap,
            &Options {
                method: m,
                samples: s,
                ..Default::default()
            },
            &(),
        )
        .unwrap();
        let dt = t.elapsed();
        let f = subsurf_decoder::Bssrdf::parse(&e.bytes).unwrap();
        let c = compare(&cap, &f, &()).unwrap();
        let re = c.albedo.relative_errors();
        let re = re.iter().sum::<f64>() / re.len() as f64;
        let ps: Vec<String> = c
            .lit
            .iter()
            .map(|r| {
                let r = r.normalised();
                format!(
                    "{:.2} ({:.4})",
                    psnr_db(&r.reference, &r.image),
                    ssim(&r.reference, &r.image, cap.width()).unwrap()
                )
            })
            .collect();
        println!(
            "{:?} {} S {} bytes {} cost {:.1} rel {:.5} psnr {} time {:?}",
            m,
            a[1],
            e.samples,
            e.bytes.len(),
            e.cost,
            re,
            ps.join(" / "),
            dt
        );
    }
}
