//! An embedded font, so that a picture does not depend on the computer's fonts; in PNG pictures this module draws the
//! letters.
//!
//! The drawing library begins every letter at a whole pixel, without the bearing that the font specifies on its left:
//! `136` would look like `1 36`.

use std::sync::{LazyLock, Once};

use ab_glyph::{Font, FontRef, PxScale, ScaleFont, point};
use epaint_default_fonts::UBUNTU_LIGHT;
use plotters::prelude::{BitMapBackend, DrawingBackend};
use plotters::style::text_anchor::{HPos, VPos};
use plotters::style::{FontStyle, register_font};
use plotters_backend::{BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingErrorKind};

static FONT: LazyLock<FontRef<'static>> =
    LazyLock::new(|| FontRef::try_from_slice(UBUNTU_LIGHT).expect("the font is valid"));

/// Registers the font for measuring text and for SVG pictures.
pub(super) fn register() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let registered = register_font("sans-serif", FontStyle::Normal, UBUNTU_LIGHT);
        debug_assert!(registered.is_ok(), "the font is valid");
    });
}

/// A PNG picture with letters at the positions that the font specifies, including fractions of a pixel.
pub(super) struct Pixels<'a>(pub(super) BitMapBackend<'a>);

type DrawResult<'a> = Result<(), DrawingErrorKind<<BitMapBackend<'a> as DrawingBackend>::ErrorType>>;

impl<'a> DrawingBackend for Pixels<'a> {
    type ErrorType = <BitMapBackend<'a> as DrawingBackend>::ErrorType;

    fn get_size(&self) -> (u32, u32) {
        self.0.get_size()
    }

    fn ensure_prepared(&mut self) -> DrawResult<'a> {
        self.0.ensure_prepared()
    }

    fn present(&mut self) -> DrawResult<'a> {
        self.0.present()
    }

    fn draw_pixel(&mut self, at: BackendCoord, color: BackendColor) -> DrawResult<'a> {
        self.0.draw_pixel(at, color)
    }

    fn draw_line<S: BackendStyle>(
        &mut self,
        from: BackendCoord,
        to: BackendCoord,
        style: &S,
    ) -> DrawResult<'a> {
        self.0.draw_line(from, to, style)
    }

    fn draw_rect<S: BackendStyle>(
        &mut self,
        from: BackendCoord,
        to: BackendCoord,
        style: &S,
        fill: bool,
    ) -> DrawResult<'a> {
        self.0.draw_rect(from, to, style, fill)
    }

    fn draw_text<S: BackendTextStyle>(&mut self, text: &str, style: &S, at: BackendCoord) -> DrawResult<'a> {
        let size = style.size() as f32;
        let (width, height) = (width(text, size), size / 1.24);
        let left = match style.anchor().h_pos {
            HPos::Left => 0.0,
            HPos::Center => -width / 2.0,
            HPos::Right => -width,
        };
        let up = match style.anchor().v_pos {
            VPos::Top => 0.0,
            VPos::Center => -height / 2.0,
            VPos::Bottom => -height,
        };
        // The baseline lies between two rows of pixels, so that the lower edges of letters are sharp.
        let foot = libm::roundf(at.1 as f32 + up + BASELINE * size);
        self.letters(text, size, (at.0 as f32 + left, foot), style.color())
    }
}

/// The distance of the baseline from the top of a text, as a fraction of its size.
const BASELINE: f32 = 0.75;

impl<'a> Pixels<'a> {
    /// Draws letters one after another, beginning at a position on the baseline.
    fn letters(
        &mut self,
        text: &str,
        size: f32,
        (left, foot): (f32, f32),
        color: BackendColor,
    ) -> DrawResult<'a> {
        for (letter, along) in places(text, size) {
            let glyph = letter.with_scale_and_position(PxScale::from(size), point(left + along, foot));
            let Some(outline) = FONT.outline_glyph(glyph) else { continue };
            let corner = outline.px_bounds().min;
            let mut covered = Vec::new();
            outline.draw(|x, y, part| covered.push((x as i32, y as i32, part)));
            for (x, y, part) in covered {
                self.draw_pixel((corner.x as i32 + x, corner.y as i32 + y), color.mix(part.into()))?;
            }
        }
        Ok(())
    }
}

/// The letters of a text, each with its distance from the beginning in pixels.
fn places(text: &str, size: f32) -> Vec<(ab_glyph::GlyphId, f32)> {
    let font = FONT.as_scaled(size);
    let (mut along, mut before) = (0.0, None);
    let place = |character| {
        let letter = font.glyph_id(character);
        along += before.map_or(0.0, |before| font.kern(before, letter));
        before = Some(letter);
        let place = (letter, along);
        along += font.h_advance(letter);
        place
    };
    text.chars().map(place).collect()
}

/// Returns the width of a text, in pixels.
fn width(text: &str, size: f32) -> f32 {
    let last = places(text, size).pop();
    last.map_or(0.0, |(letter, along)| along + FONT.as_scaled(size).h_advance(letter))
}

#[cfg(test)]
mod tests {
    use plotters::style::{IntoFont, TextStyle};

    use super::*;

    /// The columns of pixels covered by a text of size 13.
    fn covered(text: &str) -> Vec<u32> {
        let (width, height) = (60, 20);
        let mut pixels = vec![255; (width * height * 3) as usize];
        let mut picture = Pixels(BitMapBackend::with_buffer(&mut pixels, (width, height)));
        register();
        let style = TextStyle::from(("sans-serif", 13).into_font());
        picture.draw_text(text, &style, (5, 2)).expect("it fits");
        drop(picture);
        let is_dark = |x: &u32| (0..height).any(|y| pixels[((y * width + x) * 3) as usize] < 128);
        (0..width).filter(is_dark).collect()
    }

    #[test]
    fn letter_spacing_is_that_of_the_font() {
        // Three stems at the distance of a digit's width: 0.559 of the size for this font's figures.
        let stems = covered("111");
        let groups = stems.chunk_by(|a, b| b - a == 1).map(|group| group[group.len() - 1]);
        let right_edges: Vec<u32> = groups.collect();
        let [first, second, third] = right_edges[..] else { panic!("three letters: {stems:?}") };
        let apart = width("1", 13.0);
        for (steps, found) in [(1.0, second - first), (2.0, third - first)] {
            assert!((found as f32 - steps * apart).abs() <= 1.0, "{stems:?} with {apart} between them");
        }
    }
}
