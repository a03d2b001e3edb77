//! Whether the path tracer's mean is right, against closed forms.
