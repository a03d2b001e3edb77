//! A virtual display that runs the demo, and a mouse.

use std::fs;
use std::io::{BufRead, BufReader};
use std::ops::Range;
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Time limit for an answer. It includes the first one, which compiles shaders.
const PATIENCE: Duration = Duration::from_secs(120);

/// Time without a change after which a picture has come to rest.
const REST: Duration = Duration::from_millis(1000);

/// Interval between two looks at the screen: far less than a frame takes.
const LOOK: Duration = Duration::from_millis(2);

pub struct Desktop {
    server: Child,
    demo: Option<Child>,
    display: String,
    folder: PathBuf,
}

impl Desktop {
    /// Opens the demo with a saved state. If that is impossible, prints the reason and returns `None`.
    pub fn open([width, height]: [u32; 2], saved: &str) -> Option<Self> {
        for program in ["Xvfb", "xdotool"] {
            if Command::new(program).arg("-version").stdout(Stdio::null()).stderr(Stdio::null()).status().is_err() {
                println!("not checked: there is no {program} (Debian, Ubuntu: apt-get install xvfb xdotool)");
                return None;
            }
        }
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let name = format!("asvgf-desktop-{}-{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
        let folder = std::env::temp_dir().join(name);
        fs::create_dir_all(&folder).expect("a folder for the screen");
        // The server chooses a free number and prints it. The screen is a file in that folder.
        let mut server = Command::new("Xvfb")
            .args(["-displayfd", "1", "-nolisten", "tcp", "-screen", "0", &format!("{width}x{height}x24"), "-fbdir"])
            .arg(&folder)
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("a display");
        let mut number = String::new();
        let told = BufReader::new(server.stdout.take().expect("a pipe")).read_line(&mut number);
        let mut desktop = Self { server, demo: None, display: format!(":{}", number.trim()), folder };
        assert!(told.is_ok() && !number.trim().is_empty(), "Xvfb has ended");
        let state = desktop.folder.join("state.json");
        fs::write(&state, saved).expect("a file");
        let demo = Command::new(env!("CARGO_BIN_EXE_asvgf-demo"))
            .args(["--size", &format!("{width}x{height}"), "--state"])
            .arg(state)
            .env("DISPLAY", &desktop.display)
            .env_remove("WAYLAND_DISPLAY")
            .spawn();
        desktop.demo = Some(demo.expect("the demo starts"));
        Some(desktop)
    }

    /// Runs a command of xdotool.
    pub fn act(&self, words: &str) {
        let done = Command::new("xdotool").args(words.split(' ')).env("DISPLAY", &self.display).status();
        assert!(done.is_ok_and(|status| status.success()), "xdotool {words}");
    }

    /// Moves the pointer to a pixel.
    pub fn point(&self, [x, y]: [u32; 2]) {
        self.act(&format!("mousemove {x} {y}"));
    }

    /// The content of the screen.
    pub fn frame(&self) -> Frame {
        Frame(fs::read(self.folder.join("Xvfb_screen0")).expect("a screen"))
    }

    /// Waits until the observed part has come to rest and has more than one colour. Returns it.
    pub fn settle<T: PartialEq + Varied>(&self, look: impl Fn(&Frame) -> T) -> T {
        let start = Instant::now();
        let (mut last, mut since) = (look(&self.frame()), start);
        while since.elapsed() < REST || !last.is_varied() {
            assert!(start.elapsed() < PATIENCE, "it does not come to rest");
            sleep(LOOK);
            let now = look(&self.frame());
            if now != last {
                (last, since) = (now, Instant::now());
            }
        }
        last
    }

    /// Measures the time from an act to the first change of the observed part.
    pub fn answer<T: PartialEq>(&self, words: &str, look: impl Fn(&Frame) -> T) -> Duration {
        let before = look(&self.frame());
        let start = Instant::now();
        self.act(words);
        while look(&self.frame()) == before {
            assert!(start.elapsed() < PATIENCE, "no answer to {words}");
            sleep(LOOK);
        }
        start.elapsed()
    }
}

impl Drop for Desktop {
    fn drop(&mut self) {
        for child in self.demo.iter_mut().chain([&mut self.server]) {
            // The process may have ended by itself.
            let _ = child.kill();
            let _ = child.wait();
        }
        let _ = fs::remove_dir_all(&self.folder);
    }
}

/// Things that can be blank.
pub trait Varied {
    fn is_varied(&self) -> bool;
}

impl Varied for Vec<[u8; 3]> {
    fn is_varied(&self) -> bool {
        self.iter().any(|pixel| *pixel != self[0])
    }
}

/// Columns that a search found.
impl Varied for Vec<u32> {
    fn is_varied(&self) -> bool {
        !self.is_empty()
    }
}

/// A screen as a file in the format XWD, big-endian, with its pixels in the server's format.
pub struct Frame(Vec<u8>);

impl Frame {
    /// The pixels of a rectangle, row by row.
    pub fn pixels(&self, columns: Range<u32>, rows: Range<u32>) -> Vec<[u8; 3]> {
        let word = |i: usize| {
            let bytes = self.0[4 * i..].first_chunk::<4>().expect("a header");
            u32::from_be_bytes(*bytes) as usize
        };
        // The header's fields header_size, bytes_per_line and ncolors (12 bytes each).
        let (header, line, colors) = (word(0), word(12), word(19));
        let start = header + 12 * colors;
        let pixel = |x: u32, y: u32| {
            let at = start + y as usize * line + 4 * x as usize;
            [self.0[at + 2], self.0[at + 1], self.0[at]]
        };
        rows.flat_map(|y| columns.clone().map(move |x| (x, y))).map(|(x, y)| pixel(x, y)).collect()
    }
}
