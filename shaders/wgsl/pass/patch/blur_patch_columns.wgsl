// The second axis.
@fragment
fn blur(@builtin(position) at: vec4<f32>) -> MapsAndSums {
    let maps = blurred(vec2<i32>(at.xy));
    return maps_and_sums_of(maps, summed(vec2<u32>(at.xy), maps));
}
