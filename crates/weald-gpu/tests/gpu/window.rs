//! Views of a window: drawn on a device that is shared, without waiting, at once, of any size, and asked what they show.

use std::time::{Duration, Instant};

use crate::programs::{gpu, refusal};
use crate::scenes::{above, lakes, meadow, mountains, options, view};
use weald::picture::{Camera, LitScene};
use weald::random::{hash2, unit};
use weald_gpu::{Gpu, Pick, Renderer, Screen};

/// Times that a view is drawn until all of its grass is sown and its answers have come.
const MAX_PICTURES: usize = 2000;

/// A device that no other test draws on, so that nothing of theirs is counted or waited for.
fn own_gpu() -> Option<Gpu> {
    gpu().map(|_| Gpu::any().expect("an adapter"))
}

fn adapter() -> wgpu::Adapter {
    let mut description = wgpu::InstanceDescriptor::new_without_display_handle();
    description.backends = wgpu::Backends::VULKAN;
    let adapters =
        pollster::block_on(wgpu::Instance::new(description).enumerate_adapters(wgpu::Backends::VULKAN));
    adapters.into_iter().next().expect("an adapter")
}

fn opened(adapter: &wgpu::Adapter, description: &wgpu::DeviceDescriptor<'_>) -> (wgpu::Device, wgpu::Queue) {
    pollster::block_on(adapter.request_device(description)).expect("it opens")
}

/// The longest that a call took of the caller's time, but for what the driver did in it: software draws while it is given
/// what to draw.
struct Stall(Duration);

impl Stall {
    fn draw(&mut self, renderer: &mut Renderer, screen: &mut Screen, camera: &Camera) {
        let begun = Instant::now();
        renderer.draw_on(screen, camera).expect("drawn");
        self.0 = self.0.max(begun.elapsed().saturating_sub(screen.submitting_for_a_test()));
        while screen.in_flight() > 1 {
            screen.answers().expect("none is asked");
        }
    }
}

#[test]
fn a_window_shares_its_device_and_one_that_was_opened_with_less_is_refused() {
    if gpu().is_none() {
        return;
    }
    let adapter = adapter();
    let (device, queue) = opened(&adapter, &Gpu::device_descriptor(&adapter));
    let gpu = Gpu::shared(&adapter, &device, &queue).expect("it has what is needed");
    let scene = LitScene::new(&view(), &mountains()).expect("a scene");
    let mut renderer = Renderer::new(&gpu, &scene, options(1)).expect("it can be drawn");
    let mut screen = renderer.screen([320, 180]).expect("it fits");
    renderer.draw_on(&mut screen, &scene.camera()).expect("drawn");
    assert_eq!(screen.view().texture().format(), wgpu::TextureFormat::Rgba8Unorm);
    assert_eq!(screen.image().expect("read back"), renderer.render(&scene.camera()).expect("drawn"));
    // What the window does wrong is said by the next call, and then no more.
    let description = wgpu::BufferDescriptor {
        label: None,
        size: 3,
        usage: wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: true,
    };
    drop(device.create_buffer(&description));
    assert!(refusal(renderer.draw_on(&mut screen, &scene.camera())).contains("drawing failed"));
    renderer.draw_on(&mut screen, &scene.camera()).expect("drawn");
    let mut less = Gpu::device_descriptor(&adapter);
    less.required_limits.max_storage_buffers_per_shader_stage = 4;
    let (device, queue) = opened(&adapter, &less);
    let message = refusal(Gpu::shared(&adapter, &device, &queue));
    for part in ["max_storage_buffers_per_shader_stage is 4", "8 are needed", "Gpu::device_descriptor"] {
        assert!(message.contains(part), "{part}: {message}");
    }
}

#[test]
fn two_views_of_other_sizes_and_places_show_what_each_shows_alone() {
    let Some(gpu) = own_gpu() else { return };
    let landscape = meadow();
    let scene = LitScene::new(&view(), &landscape).expect("a scene");
    let mut renderer = Renderer::new(&gpu, &scene, options(4)).expect("it can be drawn");
    renderer.plant(&scene, &landscape).expect("grass");
    let views = [
        ([160, 90], above(&scene, [30.0, 90.0], 1.6, 10.0, 20.0)),
        ([128, 128], above(&scene, [90.0, 40.0], 2.0, 15.0, 250.0)),
    ];
    let alone = views.map(|(size, camera)| {
        renderer.resize(size).expect("it fits");
        renderer.render(&camera).expect("drawn")
    });
    let mut screens = views.map(|(size, _)| renderer.screen(size).expect("it fits"));
    let mut stall = Stall(Duration::ZERO);
    let shown = (0..MAX_PICTURES).find(|_| {
        for (screen, (_, camera)) in screens.iter_mut().zip(&views) {
            stall.draw(&mut renderer, screen, camera);
        }
        screens.iter().zip(&alone).all(|(screen, alone)| screen.image().expect("read back") == *alone)
    });
    println!("shown after {shown:?} pictures; drawing took {:?} at most", stall.0);
    assert!(shown.is_some(), "grass stands in both views");
    assert_ne!(alone[0], alone[1]);
}

#[test]
fn a_view_that_was_resized_500_times_holds_no_more_than_a_new_one() {
    let Some(gpu) = own_gpu() else { return };
    let scene = LitScene::new(&view(), &mountains()).expect("a scene");
    let mut renderer = Renderer::new(&gpu, &scene, options(4)).expect("it can be drawn");
    let mut screen = renderer.screen([64, 36]).expect("it fits");
    let mut stall = Stall(Duration::ZERO);
    stall.draw(&mut renderer, &mut screen, &scene.camera());
    let (picture, held, by_driver) =
        (screen.image().expect("read back"), gpu.allocated(), gpu.allocated_by_driver());
    for step in 0..500_u32 {
        let begun = Instant::now();
        renderer.resize_screen(&mut screen, [8 + step % 60, 8 + step % 35]).expect("it fits");
        stall.0 = stall.0.max(begun.elapsed());
        // Pictures take longer than sizes.
        if step % 25 == 0 {
            stall.draw(&mut renderer, &mut screen, &scene.camera());
        }
    }
    renderer.resize_screen(&mut screen, [64, 36]).expect("it fits");
    stall.draw(&mut renderer, &mut screen, &scene.camera());
    assert_eq!((screen.image().expect("read back"), gpu.allocated()), (picture, held));
    // The numbers of a picture may still be on their way.
    let off = gpu.allocated_by_driver().zip(by_driver).map(|(now, before)| now.abs_diff(before));
    assert!(off.is_none_or(|bytes| bytes < 1 << 16), "{off:?} bytes are left");
    println!("resizing and drawing took {:?} at most", stall.0);
    assert!(renderer.resize_screen(&mut screen, [0, 36]).is_err() && screen.size() == [64, 36]);
}

/// A number from 0 to 1.
fn random(seed: u64, at: i64) -> f32 {
    unit(hash2(seed, at, 5)) as f32
}

/// Lengths of rays through places up to half a pixel beside and above and below a place, where they meet the ground.
fn marched(scene: &LitScene, camera: &Camera, [width, height]: [f32; 2], at: [f32; 2]) -> Vec<Option<f32>> {
    let off = |step: u8| 0.125 * f32::from(step) - 0.5;
    let around = (0..81).map(|look| [at[0] + off(look % 9), at[1] + off(look / 9)]);
    let ray = |[x, y]: [f32; 2]| camera.ray([2.0 * x / width - 1.0, 1.0 - 2.0 * y / height]);
    around.map(|at| scene.met_by(&ray(at))).collect()
}

/// Whether a point is what rays within half a pixel meet, and appears where it was asked.
fn is_right(scene: &LitScene, camera: &Camera, size: [f32; 2], pick: &Pick) -> bool {
    let marched = marched(scene, camera, size, pick.at);
    let Some(ground) = pick.ground else { return marched.iter().any(Option::is_none) };
    let met = marched.iter().flatten();
    let (least, most) = met.fold((f32::INFINITY, 0.0_f32), |(low, high), &at| (low.min(at), high.max(at)));
    let away: f32 = (0..3).map(|axis| (ground.point[axis] - camera.eye[axis]).powi(2)).sum::<f32>().sqrt();
    let [x, y] = camera.project(ground.point).expect("it was seen");
    let off = [0.5 * (1.0 + x) * size[0] - pick.at[0], 0.5 * (1.0 - y) * size[1] - pick.at[1]];
    (least * 0.9999..=most * 1.0001).contains(&away) && off[0].hypot(off[1]) <= 0.05
}

#[test]
fn a_thousand_picks_are_within_half_a_pixel_of_the_marched_ones() {
    let Some(gpu) = gpu() else { return };
    let scene = LitScene::new(&view(), &lakes()).expect("a scene");
    let cameras = [
        scene.camera(),
        above(&scene, [1600.0, 1700.0], 60.0, 12.0, 40.0),
        above(&scene, [900.0, 2300.0], 400.0, 55.0, 200.0),
    ];
    let size = [320.0, 180.0];
    for samples in [1, 4] {
        let mut renderer = Renderer::new(&gpu, &scene, options(samples)).expect("it can be drawn");
        let mut screen = renderer.screen([320, 180]).expect("it fits");
        let (mut right, mut ground, mut asked) = (0, 0, 0);
        for (number, camera) in (0..).zip(&cameras) {
            let count = [334, 333, 333][number];
            for at in 0..count {
                let place = |seed| random(seed + number as u64, at);
                screen.ask([size[0] * place(10), size[1] * place(20)]);
            }
            let mut picks = Vec::new();
            for _ in 0..MAX_PICTURES {
                renderer.draw_on(&mut screen, camera).expect("drawn");
                picks.extend(screen.answers().expect("answered"));
                if picks.len() as i64 == count {
                    break;
                }
            }
            asked += picks.len();
            ground += picks.iter().filter(|pick| pick.ground.is_some()).count();
            right += picks.iter().filter(|pick| is_right(&scene, camera, size, pick)).count();
        }
        println!("{samples} samples: {right} of {asked} right, {ground} on the ground");
        assert!(asked == 1000 && right == 1000 && ground > 600, "{right} of {asked}; {ground} on the ground");
    }
}
