//! The textures that hold a plan's images. Images whose lifetimes do not overlap share one.
//!
//! WebGPU has no aliasing of memory, but a texture may hold one image after another if both have its format and extent. Over the
//! steps of a frame this is register allocation: an image gets a free texture at the step that writes it, and returns it after
//! the last step that reads it. An image that the next frame needs keeps its texture until that frame has read it.

use super::{Bound, Grid, Image, Plan, Slot, Step};
use std::collections::{BTreeMap, BTreeSet};
use wgpu::TextureFormat;

/// Format and extent of a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Kind {
    pub format: TextureFormat,
    pub grid: Grid,
}

impl Kind {
    fn of(image: Image) -> Self {
        Self { format: image.format(), grid: image.grid() }
    }

    /// Bytes of a texture for a picture of this size.
    pub fn bytes(self, size: [u32; 2]) -> u64 {
        let [width, height] = self.grid.extent(size).map(u64::from);
        width * height * u64::from(self.format.block_copy_size(None).unwrap_or(0))
    }
}

/// The textures of a denoiser, by number, and their contents.
#[derive(Clone, Debug, Default)]
pub(crate) struct Memory {
    /// The kind of each texture; `None` if it was given up.
    textures: Vec<Option<Kind>>,
    /// Textures that must not be written to yet.
    busy: BTreeSet<usize>,
    /// The textures of the last frame's images.
    before: BTreeMap<Image, usize>,
    /// Textures that are bound in place of the last frame's images when there is no last frame. No result depends on their contents.
    absent: BTreeMap<Image, usize>,
    /// The textures that hold, or held, this frame's images.
    now: BTreeMap<Image, usize>,
    /// The images of this frame whose texture another image has taken since.
    overwritten: BTreeSet<Image>,
    /// The images of this frame that the next one needs.
    needed: BTreeSet<Image>,
    /// True if this frame is complete, so that the next one can continue it.
    complete: bool,
}

impl Memory {
    /// The images of the last frame that a new frame finds. If the last frame did not write an image, it is from the frame before.
    fn left(&self) -> BTreeMap<Image, usize> {
        let mut left = self.before.clone();
        if self.complete {
            left.retain(|image, _| self.needed.contains(image));
            let fresh = self.now.iter().filter(|(image, _)| self.needed.contains(image));
            left.extend(fresh.map(|(&image, &texture)| (image, texture)));
        }
        left
    }

    /// True if a new frame finds all images of the last one that these steps read.
    pub fn has_all_before(&self, steps: &[Step]) -> bool {
        let left = self.left();
        slots(steps).all(|slot| !matches!(slot, Slot::Before(image) if !left.contains_key(&image)))
    }

    /// Begins a frame. The images of the last one stay until this one is complete.
    pub fn begin(&mut self) {
        self.before = self.left();
        self.busy = self.before.values().copied().collect();
        self.absent.clear();
        self.now.clear();
        self.overwritten.clear();
        self.complete = false;
    }

    /// Assigns textures to the images of `steps[from..]`; earlier steps have theirs. `over(step, slot)` is true if a step is the last
    /// to use a slot, so that its texture is free for later steps.
    pub fn place(&mut self, steps: &[Step], from: usize, over: impl Fn(usize, Slot) -> bool) {
        for (i, step) in steps.iter().enumerate() {
            for &Bound { slot, .. } in step.bindings.iter().filter(|_| i >= from) {
                match slot {
                    Slot::Now(image) if !self.now.contains_key(&image) => {
                        let texture = self.take(Kind::of(image));
                        self.now.insert(image, texture);
                    }
                    Slot::Before(image) if self.texture(slot).is_none() => {
                        let texture = self.take(Kind::of(image));
                        self.absent.insert(image, texture);
                    }
                    _ => {}
                }
            }
            for &Bound { slot, .. } in &step.bindings {
                if let Some(texture) = self.texture(slot).filter(|_| over(i, slot)) {
                    self.busy.remove(&texture);
                }
            }
        }
    }

    /// Ends a frame. It leaves the images in `needed` for the next.
    pub fn end(&mut self, needed: BTreeSet<Image>) {
        self.needed = needed;
        self.complete = true;
    }

    /// Drops a frame that was begun: the next one continues the frame before.
    pub fn abandon(&mut self) {
        self.now.clear();
        self.complete = false;
    }

    /// Gives up the textures that hold no image of this frame or of the last one.
    pub fn shrink(&mut self) {
        let maps = [&self.now, &self.before, &self.absent];
        let used: BTreeSet<usize> = maps.iter().flat_map(|map| map.values()).copied().collect();
        for (number, texture) in self.textures.iter_mut().enumerate() {
            if !used.contains(&number) {
                *texture = None;
            }
        }
    }

    /// The texture behind a slot.
    pub fn texture(&self, slot: Slot) -> Option<usize> {
        match slot {
            Slot::Now(image) => self.now.get(&image).copied(),
            Slot::Before(image) => self.before.get(&image).or_else(|| self.absent.get(&image)).copied(),
            Slot::Target | Slot::Host(_) => None,
        }
    }

    /// True if this frame was ended and not abandoned.
    pub fn is_complete(&self) -> bool {
        self.complete
    }

    /// True if this frame's image is still there at its end.
    pub fn holds(&self, image: Image) -> bool {
        self.now.contains_key(&image) && !self.overwritten.contains(&image)
    }

    /// The kind of each texture.
    pub fn textures(&self) -> &[Option<Kind>] {
        &self.textures
    }

    /// Takes a texture that may be overwritten, and marks it as busy.
    fn take(&mut self, kind: Kind) -> usize {
        let free = (0..self.textures.len()).find(|i| self.textures[*i] == Some(kind) && !self.busy.contains(i));
        let texture = free.unwrap_or_else(|| match self.textures.iter().position(Option::is_none) {
            Some(given_up) => given_up,
            None => {
                self.textures.push(None);
                self.textures.len() - 1
            }
        });
        self.textures[texture] = Some(kind);
        self.busy.insert(texture);
        self.overwritten.extend(self.now.iter().filter(|(_, t)| **t == texture).map(|(image, _)| *image));
        texture
    }
}

fn slots(steps: &[Step]) -> impl Iterator<Item = Slot> {
    steps.iter().flat_map(|step| &step.bindings).map(|bound| bound.slot)
}

/// The images of a plan that the next frame reads.
pub(crate) fn needed(images: &[(Image, bool)]) -> BTreeSet<Image> {
    images.iter().filter(|(_, before)| *before).map(|(image, _)| *image).collect()
}

impl Plan {
    /// Bytes of the textures that frames of this plan need, for a picture of this size. `views` is
    /// [`DenoiserDescriptor::views`](crate::DenoiserDescriptor::views).
    pub fn bytes(&self, size: [u32; 2], views: bool) -> u64 {
        self.textures(views).iter().map(|kind| kind.bytes(size)).sum()
    }

    /// The kinds of those textures.
    fn textures(&self, views: bool) -> Vec<Kind> {
        let (mut memory, needed) = (Memory::default(), needed(&self.images()));
        // The first frame has no last one; all others are alike.
        for _ in 0..2 {
            memory.begin();
            let begun = self.surface_steps();
            memory.place(&self.steps[..begun], 0, |_, _| false);
            memory.place(&self.steps, begun, |step, slot| self.is_over(step, slot, &needed, views));
            memory.end(needed.clone());
        }
        memory.textures().iter().copied().flatten().collect()
    }

    /// True if the step of this number is the last to use a slot. With `views`, all images of this frame are kept until the next.
    pub(crate) fn is_over(&self, step: usize, slot: Slot, needed: &BTreeSet<Image>, views: bool) -> bool {
        let used = slots(&self.steps[step + 1..]).any(|other| other == slot);
        let written = |image| slots(&self.steps).any(|slot| slot == Slot::Now(image));
        !used
            && match slot {
                Slot::Now(image) => !views && !needed.contains(&image),
                Slot::Before(image) => !views && (written(image) || !needed.contains(&image)),
                Slot::Target | Slot::Host(_) => false,
            }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::{Changes, HostInputs, PairInputs};
    use crate::{FilterSettings, Gradient, Mode, Settings};

    /// Plans of a host's frames that keep different images, each with the plan for the case that everything changes.
    fn plans() -> Vec<(Plan, Plan)> {
        let gradients = [Gradient::Reshade, Gradient::Pairs, Gradient::Statistics, Gradient::Lambda, Gradient::Off];
        let filters = gradients.map(|gradient| FilterSettings { gradient, ..Default::default() });
        let filters = filters.into_iter().chain([FilterSettings::classic()]);
        let short = |f: FilterSettings| {
            [f.clone(), FilterSettings { iterations: 1, ..f.clone() }, FilterSettings { iterations: 0, ..f }]
        };
        let modes = [Mode::Denoise, Mode::Noisy, Mode::Reference];
        let settings = filters
            .flat_map(short)
            .flat_map(|filter| modes.map(|mode| Settings { mode, filter: filter.clone(), ..Settings::adaptive() }));
        let inputs =
            [false, true].map(|on| HostInputs { instances: on, albedo: on, emission: on, ..Default::default() });
        let all: Vec<_> = settings.flat_map(|s| inputs.map(|t| (s.clone(), t))).collect();
        let changes = [Changes::ANY, Changes { camera: true, scene: false }, Changes::NONE];
        let plan = |settings: &Settings, inputs: &HostInputs, changes| {
            Plan::hosted(inputs, settings, changes, TextureFormat::Rgba32Float)
        };
        all.iter().flat_map(|(s, t)| changes.map(|c| (plan(s, t, c), plan(s, t, Changes::ANY)))).collect()
    }

    /// Runs frames of plans in turn, and checks at each read that the texture holds the right image of the right frame. The contents
    /// are tracked here, not in [`Memory`].
    fn follow(frames: &[&(Plan, Plan)], views: bool) {
        let mut memory = Memory::default();
        let mut contents: BTreeMap<usize, (Image, usize)> = BTreeMap::new();
        let mut written: BTreeMap<Image, usize> = BTreeMap::new();
        for (number, (plan, most)) in frames.iter().enumerate() {
            let continued = memory.has_all_before(&most.steps);
            assert_eq!(
                continued,
                number > 0 || needed(&most.images()).is_empty(),
                "frame {number} finds what the last one left"
            );
            let before = written.clone();
            memory.begin();
            let begun = plan.surface_steps();
            memory.place(&plan.steps[..begun], 0, |_, _| false);
            memory.place(&plan.steps, begun, |step, slot| plan.is_over(step, slot, &needed(&most.images()), views));
            memory.end(needed(&most.images()));
            for step in &plan.steps {
                let (outputs, inputs): (Vec<_>, Vec<_>) = step.bindings.iter().partition(|bound| bound.written);
                let place = |slot| memory.texture(slot).unwrap_or_else(|| panic!("{slot:?} has no texture"));
                for &&Bound { name, slot, .. } in &inputs {
                    match slot {
                        Slot::Now(image) => {
                            assert_eq!(contents[&place(slot)], (image, number), "{:?} {name}", step.pass)
                        }
                        Slot::Before(image) if continued => {
                            assert_eq!(contents[&place(slot)], (image, before[&image]), "{:?} {name}", step.pass);
                        }
                        _ => {}
                    }
                }
                for &&Bound { name, slot, .. } in &outputs {
                    if let Slot::Now(image) = slot {
                        let texture = place(slot);
                        let read = |other: &&Bound| memory.texture(other.slot) == Some(texture) && other.slot != slot;
                        assert!(
                            step.bindings.iter().find(read).is_none(),
                            "{:?} {name} is written where it is read",
                            step.pass
                        );
                        contents.insert(texture, (image, number));
                        written.insert(image, number);
                    }
                }
            }
            for (&image, &frame) in &written {
                let there = memory.texture(Slot::Now(image)).is_some_and(|t| contents[&t] == (image, number));
                assert!(!memory.holds(image) || there, "{image:?} is said to be there");
                let kept = frame < number || memory.holds(image) && there;
                assert!(!views || kept, "{image:?} is kept");
            }
        }
    }

    #[test]
    fn no_image_is_written_over_while_it_is_needed() {
        for same in plans().chunks_exact(3) {
            for (plan, views) in same.iter().flat_map(|plan| [(plan, false), (plan, true)]) {
                // In the first frame, anything may have changed.
                follow(&[&same[0], plan, plan, plan, plan], views);
            }
        }
    }

    #[test]
    fn frames_that_leave_passes_out_keep_what_later_ones_need() {
        let plans = plans();
        for same in plans.chunks_exact(3) {
            let [any, camera, still] = [&same[0], &same[1], &same[2]];
            follow(&[any, still, still, any, camera, camera, any, any, still, camera, any], false);
        }
    }

    /// docs/leaving-out.md quotes these: images per pixel, and images of strata per nine pixels.
    #[test]
    fn frames_take_no_more_than_the_images_that_are_alive_at_once() {
        // The size is in whole strata.
        let size = [300, 300];
        let bytes_of = |filter: FilterSettings, inputs: HostInputs| {
            let settings = Settings { filter, ..Settings::adaptive() };
            let plan = Plan::hosted(&inputs, &settings, Changes::ANY, TextureFormat::Rgba32Float);
            plan.bytes(size, false) as f64 / f64::from(size[0] * size[1])
        };
        let bytes = |gradient, inputs| {
            let believing = FilterSettings { gradient, outlier_limit: 0.0, ..Default::default() };
            let bare = bytes_of(FilterSettings { steadiness: 0.0, ..believing.clone() }, inputs);
            // Steadiness adds the output, now and before.
            let steady = bytes_of(believing, inputs);
            assert_eq!(steady, bare + 16.0, "{gradient:?}");
            // The limit adds what is kept of each stratum, and limits of half the size. The candidates, and their counts and sums, give
            // way to other images, if there are any.
            let limited = bytes_of(FilterSettings { gradient, ..Default::default() }, inputs);
            let records = match gradient {
                Gradient::Off | Gradient::Lambda => 4.5,
                _ => 1.5,
            };
            assert!((limited - steady - records * 16.0 / 9.0).abs() < 1e-9, "{gradient:?}: {}", limited - steady);
            bare
        };
        let alone = HostInputs::default();
        let all = HostInputs { albedo: true, emission: true, ..alone };
        // A constant α needs guide and history, each now and before.
        assert_eq!(bytes(Gradient::Off, alone), 32.0);
        assert_eq!(bytes(Gradient::Off, all), 32.0);
        assert_eq!(bytes(Gradient::Lambda, alone), 32.0);
        // Pairs add the strata's records, their pairs, which take turns two by two, and the host's pairs of half the size.
        let strata = 5.0 * 16.0 / 9.0;
        assert_eq!(bytes(Gradient::Pairs, alone), 32.0 + strata + 16.0 / 9.0);
        // Statistics add the strata's records, two levels of means in two images each, λ and the ratio.
        assert_eq!(bytes(Gradient::Statistics, alone), 32.0 + 7.0 * 16.0 / 9.0);
        assert_eq!(bytes(Gradient::Automatic, all), 32.0 + 7.0 * 16.0 / 9.0);
        // Re-shading adds motion and radiance; the last frame's motion and radiance give way to the history.
        assert_eq!(bytes(Gradient::Reshade, alone), 48.0 + strata);
        // An albedo adds that of both frames, and an emission itself.
        assert_eq!(bytes(Gradient::Reshade, all), 72.0 + strata);
    }

    #[test]
    fn two_signals_take_no_more_than_twice_the_memory_of_one() {
        let size = [300, 300];
        let bytes = |gradient, gloss: bool| {
            let pairs = (gradient == Gradient::Pairs).then(PairInputs::default);
            let alone = HostInputs { albedo: true, pairs, ..Default::default() };
            let inputs = HostInputs {
                specular: true,
                reflectance: true,
                roughness: true,
                hit_distance: true,
                specular_pairs: pairs,
                ..alone
            };
            let filter = FilterSettings { gradient, ..Default::default() };
            let settings = Settings { filter, ..Settings::adaptive() };
            let inputs = if gloss { inputs } else { alone };
            let plan = Plan::hosted(&inputs, &settings, Changes::ANY, TextureFormat::Rgba32Float);
            plan.bytes(size, false) as f64 / f64::from(size[0] * size[1])
        };
        for gradient in [Gradient::Off, Gradient::Pairs, Gradient::Statistics, Gradient::Reshade] {
            let [one, two] = [false, true].map(|gloss| bytes(gradient, gloss));
            println!("{gradient:?}: {one:.1} bytes per pixel for one signal, {two:.1} for two");
            assert!(one < two && two <= 2.0 * one, "{gradient:?}: {two} bytes instead of {one}");
        }
    }

    #[test]
    fn sharing_saves_memory_and_views_cost_it() {
        for (plan, _) in plans() {
            let [shared, kept] = [false, true].map(|views| plan.bytes([300, 300], views));
            assert!(shared <= kept, "{shared} bytes instead of {kept}");
            let images: u64 = plan
                .images()
                .iter()
                .map(|(image, before)| Kind::of(*image).bytes([300, 300]) * (1 + u64::from(*before)))
                .sum();
            assert_eq!(kept, images, "one texture for each image and each that is kept");
        }
    }
}
