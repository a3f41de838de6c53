//! A button that is pressed in frames and read in ticks.

use std::collections::VecDeque;

/// Remembers each press and release until a tick has seen it, in order: a tap between two ticks
/// is still one tick of being held, and two quick taps are still two presses.
#[derive(Clone, Debug, Default)]
pub struct Button {
    held: bool,
    changes: VecDeque<bool>,
}

impl Button {
    /// More than this many changes between two ticks are no intention any more.
    const MOST: usize = 4;

    /// It goes down.
    pub fn press(&mut self) {
        self.change(true);
    }

    /// It comes up.
    pub fn release(&mut self) {
        self.change(false);
    }

    fn change(&mut self, down: bool) {
        let last = self.changes.back().copied().unwrap_or(self.held);
        if last == down {
            return;
        }
        self.changes.push_back(down);
        if self.changes.len() > Self::MOST {
            // A press and its release go together.
            self.changes.drain(..2);
        }
    }

    /// Whether the next tick sees it held.
    pub fn next_tick(&mut self) -> bool {
        if let Some(down) = self.changes.pop_front() {
            self.held = down;
        }
        self.held
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tap_between_two_ticks_is_one_tick_of_being_held() {
        let mut button = Button::default();
        button.press();
        button.release();
        assert_eq!([(); 3].map(|()| button.next_tick()), [true, false, false]);
    }

    #[test]
    fn two_taps_between_two_ticks_are_two_presses() {
        let mut button = Button::default();
        for _ in 0..2 {
            button.press();
            button.release();
        }
        let seen = [(); 5].map(|()| button.next_tick());
        assert_eq!(seen, [true, false, true, false, false]);
    }

    #[test]
    fn a_held_button_stays_held_and_ends_up_as_it_is() {
        let mut button = Button::default();
        button.press();
        assert!(button.next_tick() && button.next_tick());
        for _ in 0..50 {
            button.release();
            button.press();
        }
        for _ in 0..10 {
            button.next_tick();
        }
        assert!(button.next_tick());
    }
}
