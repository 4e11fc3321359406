// Pictures of a report enlarge at a click. Beside others of their row they can be wiped: the divider follows the pointer.
// Without JavaScript a click opens the picture file.
(function () {
    'use strict';
    let dialog, stage, divider, choice, shown;

    function element(tag, parent, properties) {
        return parent.appendChild(Object.assign(document.createElement(tag), properties));
    }

    const file_of = image => image.closest('a') ? image.closest('a').href : image.src;

    // The pictures beside this one, itself among them: each with its name and file.
    function row_of(image) {
        const row = image.closest('.row') || image.closest('figure') || image.parentElement;
        return Array.from(row.querySelectorAll('img')).map(one => ({ name: one.alt, file: file_of(one) }));
    }

    function make() {
        dialog = element('dialog', document.body, {});
        const form = element('form', dialog, { method: 'dialog' });
        element('button', form, { textContent: 'Close' });
        choice = ['left', 'right'].map(side => element('select', element('label', form, { textContent: side + ' ' }), {}));
        choice.forEach(one => one.addEventListener('change', draw));
        stage = element('div', dialog, { className: 'stage' });
        shown = [element('img', stage, {}), element('img', stage, {})];
        divider = element('div', stage, { className: 'divider' });
        stage.addEventListener('pointermove', event => wipe(event.clientX / stage.clientWidth));
        stage.addEventListener('click', event => wipe(event.clientX / stage.clientWidth));
    }

    function wipe(share) {
        shown[1].style.clipPath = 'inset(0 0 0 ' + 100 * share + '%)';
        divider.style.left = 100 * share + '%';
    }

    function draw() {
        shown.forEach((image, side) => {
            image.src = choice[side].value;
            image.alt = choice[side].selectedOptions[0].textContent;
        });
        divider.hidden = choice[0].value === choice[1].value;
    }

    function open(image) {
        if (!dialog)
            make();
        const row = row_of(image), here = row.findIndex(one => one.file === file_of(image));
        choice.forEach((select, side) => {
            select.replaceChildren(...row.map(one => new Option(one.name.slice(0, 60), one.file)));
            select.selectedIndex = side === 0 ? here : row.length > 1 ? (here + 1) % row.length : here;
            select.parentElement.hidden = row.length < 2;
        });
        draw();
        dialog.showModal();
        wipe(row.length > 1 ? 0.5 : 1);
    }

    document.addEventListener('click', event => {
        const image = event.target.closest('img');
        if (!image || image.closest('dialog') || event.ctrlKey || event.metaKey || event.shiftKey)
            return;
        event.preventDefault();
        open(image);
    });
})();
