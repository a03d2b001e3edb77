//! Two halves of one picture, and the divider between them.

use eframe::egui::{
    Align2, Color32, CursorIcon, FontId, Painter, Pos2, Rect, Sense, Stroke, TextureId, Ui, pos2, vec2,
};

/// Distance in points, to either side of the divider, within which the mouse can take it.
const GRIP: f32 = 6.0;

/// A texture and the name of its content.
pub struct Half<'a> {
    pub id: TextureId,
    pub name: &'a str,
}

/// Draws the left half up to the divider and the right half from there on. Without a right half, draws one picture.
pub fn show(ui: &mut Ui, rect: Rect, left: &Half<'_>, right: Option<&Half<'_>>, divider: &mut f32) {
    let painter = ui.painter().with_clip_rect(rect);
    let Some(right) = right else {
        part(&painter, rect, left.id, [0.0, 1.0]);
        name(&painter, rect.left_top() + vec2(8.0, 8.0), Align2::LEFT_TOP, left.name);
        return;
    };
    let at = |divider: f32| rect.left() + divider * rect.width();
    let grip = Rect::from_center_size(pos2(at(*divider), rect.center().y), vec2(2.0 * GRIP, rect.height()));
    let response =
        ui.interact(grip, ui.scope_id().with("divider"), Sense::drag()).on_hover_cursor(CursorIcon::ResizeHorizontal);
    if let Some(pointer) = response.interact_pointer_pos() {
        *divider = ((pointer.x - rect.left()) / rect.width()).clamp(0.0, 1.0);
    }
    part(&painter, rect, left.id, [0.0, *divider]);
    part(&painter, rect, right.id, [*divider, 1.0]);
    painter.vline(at(*divider), rect.y_range(), Stroke::new(2.0, Color32::WHITE));
    name(&painter, rect.left_top() + vec2(8.0, 8.0), Align2::LEFT_TOP, left.name);
    name(&painter, rect.right_top() + vec2(-8.0, 8.0), Align2::RIGHT_TOP, right.name);
}

/// Draws the part of a texture between two columns, 0…1, at its place in the picture.
fn part(painter: &Painter, rect: Rect, id: TextureId, [from, to]: [f32; 2]) {
    let x = |t: f32| rect.left() + t * rect.width();
    let place = Rect::from_min_max(pos2(x(from), rect.top()), pos2(x(to), rect.bottom()));
    let texels = Rect::from_min_max(pos2(from, 0.0), pos2(to, 1.0));
    painter.image(id, place, texels, Color32::WHITE);
}

fn name(painter: &Painter, at: Pos2, anchor: Align2, text: &str) {
    let font = FontId::proportional(16.0);
    let galley = painter.layout_no_wrap(text.to_owned(), font, Color32::WHITE);
    let place = anchor.anchor_size(at, galley.size());
    painter.rect_filled(place.expand(4.0), 4.0, Color32::from_black_alpha(160));
    painter.galley(place.min, galley, Color32::WHITE);
}
