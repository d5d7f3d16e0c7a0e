//! tmp
use subsurf_encoder::simulate::*; use subsurf_encoder::capture::*; use subsurf_decoder::bssrdf::Addressing;
fn main(){
  let a:Vec<String>=std::env::args().collect();
  let n:usize=a[2].parse().unwrap(); let radius:usize=a[3].parse().unwrap(); let pitch:f64=a[4].parse().unwrap();
  let scene=*Scene::ALL.iter().find(|s|s.name()==a[1]).unwrap();
  let map=scene.map([n,n],Addressing::Clamp,1);
  let slab=Slab{map:&map,addressing:Addressing::Clamp,pitch_mm:pitch,radius,thickness_mm:20.0,eta:1.5,refine:1.0};
  let t=std::time::Instant::now();
  let side=Sidecar{pitch_mm:pitch as f32,addressing:Addressing::Clamp,eta:1.5,simulated:Some(serde_json::json!({"scene":a[1]}))};
  let path=std::path::PathBuf::from(format!("/tmp/cap/{}{}.npy",a[1],n));
  let mut img=vec![0u8;n*n*3]; let d=2*radius+1; let mut i=0;
  let w=CaptureWriter{path:&path,size:[n,n],radius,scalar:Scalar::F32,sidecar:&side};
  w.write(|sink| slab.measure(&(),|rows|{ for win in rows.chunks(d*d*3){ for c in 0..3{ let s:f32=win.iter().skip(c).step_by(3).filter(|v|v.is_finite()).sum(); img[i*3+c]=((s*(pitch*pitch) as f32).powf(1.0/2.2)*255.0).min(255.0) as u8;} i+=1;} sink(rows)})).unwrap();
  println!("{} voxels {} time {:?}",a[1],slab.voxels(),t.elapsed());
  image::save_buffer(format!("/tmp/cap/{}{}.png",a[1],n),&img,n as u32,n as u32,image::ColorType::Rgb8).unwrap();
}
