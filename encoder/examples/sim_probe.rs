use subsurf_encoder::simulate::*; use subsurf_encoder::simulate::analytic::HalfSpace; use subsurf_decoder::bssrdf::Addressing;
fn main(){
  for (name,pitch,refine) in [("marble",0.5,1.0),("skin1",0.5,1.0),("potato",0.6,1.0)] {
    let m=Medium::measured(name).unwrap();
    let map=MediumMap{size:[1,1],media:vec![m;1]};
    let slab=Slab{map:&map,addressing:Addressing::Repeat,pitch_mm:pitch,radius:12,thickness_mm:40.0,eta:1.4,refine};
    let t=std::time::Instant::now();
    let mut out=vec![];
    slab.measure::<()>(&(),|r|{out.extend_from_slice(r);Ok(())}).unwrap();
    print!("{name} {pitch} vox {} {:?}",slab.voxels(),t.elapsed());
    for c in [0,2] { let h=HalfSpace{sigma_s:m.sigma_s[c],sigma_a:m.sigma_a[c],eta:1.4};
      let w=&out[..25*25*3];
      print!(" c{c}: ");
      for dx in [0usize,1,2,3,4,6,8,12] { let s=w[(12*25+12+dx)*3+c] as f64; let e=h.pixel_rd(dx as f64,0.0,pitch); print!(" {dx}:{:+.1}%",100.0*(s/e-1.0)); }
      let s=w[(24*25+24)*3+c] as f64; let e=h.pixel_rd(12.0,12.0,pitch); print!(" corner {:+.2}%",100.0*(s/e-1.0));
    }
      println!();
  }
}
