// Renders /openapi.json: one section for each route, one table for each body. Text alone goes into the page, never markup.

const methods = ['get', 'post', 'put', 'patch', 'delete'];

function element(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.append(...children);
  return made;
}

/** Text in which `code` and line breaks mean something. */
function prose(text = '') {
  return text.split('\n\n').map((paragraph) => {
    const parts = paragraph.split('`').map((part, i) => (i % 2 ? element('code', {}, part) : part));
    return element('p', {}, ...parts);
  });
}

/** Follows the references of a document. */
function resolver(document_) {
  return function resolve(item) {
    if (!item?.$ref) return item ?? {};
    const found = item.$ref.slice(2).split('/').reduce((at, key) => at?.[key], document_);
    return resolve(found);
  };
}

function typeOf(schema, resolve) {
  if ('const' in schema) return JSON.stringify(schema.const);
  if (schema.enum) return schema.enum.map((value) => JSON.stringify(value)).join(' | ');
  if (schema.type === 'array') return `list of ${typeOf(resolve(schema.items), resolve)}`;
  return [schema.type ?? (schema.oneOf ? 'one of' : 'any')].flat().join(' or ');
}

function rangeOf(schema) {
  const parts = [];
  if ('minimum' in schema) parts.push(`from ${schema.minimum}`);
  if ('exclusiveMinimum' in schema) parts.push(`more than ${schema.exclusiveMinimum}`);
  if ('maximum' in schema) parts.push(`to ${schema.maximum}`);
  if ('exclusiveMaximum' in schema) parts.push(`to less than ${schema.exclusiveMaximum}`);
  if ('minItems' in schema) parts.push(`${schema.minItems} or more`);
  if ('maxItems' in schema) parts.push(`at most ${schema.maxItems}`);
  if (schema.pattern) parts.push(schema.pattern);
  return parts.join(' ');
}

/** Rows of a table: every field, those of nested objects with the way to them in front. */
function* rows(schema, resolve, prefix = '', depth = 0) {
  for (const [name, raw] of Object.entries(schema.properties ?? {})) {
    const field = resolve(raw);
    const where = prefix + name;
    const needed = (schema.required ?? []).includes(name);
    yield { where, field, needed };
    if (depth > 4) continue;
    yield* rows(field, resolve, `${where}.`, depth + 1);
    if (field.type === 'array') {
      yield* rows(resolve(field.items), resolve, `${where}[].`, depth + 1);
    }
    for (const variant of field.oneOf ?? []) {
      const kind = resolve(variant).properties?.kind?.const;
      yield* rows(resolve(variant), resolve, `${where}${kind ? `(${kind})` : ''}.`, depth + 1);
    }
  }
}

function table(schema, resolve, request) {
  const body = element('tbody');
  for (const { where, field, needed } of rows(schema, resolve)) {
    const otherwise = 'default' in field ? JSON.stringify(field.default) : needed ? 'required' : '';
    body.append(
      element(
        'tr',
        {},
        element('td', {}, where),
        element('td', {}, typeOf(field, resolve)),
        element('td', {}, field['x-unit'] ?? ''),
        element('td', {}, rangeOf(field)),
        ...(request ? [element('td', {}, otherwise)] : []),
        element('td', {}, field.description ?? ''),
      ),
    );
  }
  if (!body.childElementCount) return element('p', { class: 'dim' }, 'No fields.');
  const names = ['Field', 'Type', 'Unit', 'Allowed', ...(request ? ['Otherwise'] : []), 'Meaning'];
  const head = element('tr', {}, ...names.map((name) => element('th', { scope: 'col' }, name)));
  return element('table', {}, element('thead', {}, head), body);
}

function parameters(list, resolve) {
  const body = element('tbody');
  for (const parameter of list.map(resolve)) {
    const schema = resolve(parameter.schema);
    body.append(
      element(
        'tr',
        {},
        element('td', {}, parameter.name),
        element('td', {}, parameter.in),
        element('td', {}, typeOf(schema, resolve)),
        element('td', {}, rangeOf(schema)),
        element('td', {}, parameter.description ?? ''),
      ),
    );
  }
  const names = ['Parameter', 'In', 'Type', 'Allowed', 'Meaning'];
  const head = element('tr', {}, ...names.map((name) => element('th', { scope: 'col' }, name)));
  return element('table', {}, element('thead', {}, head), body);
}

/** A line for a shell that asks for the route. */
function curl(method, path, operation, resolve) {
  const examples = Object.fromEntries(
    (operation.parameters ?? []).map(resolve).map((item) => [item.name, item.example]),
  );
  const target = path.replace(/\{(\w+)\}/g, (whole, name) => examples[name] ?? whole);
  const words = ['curl'];
  if (method !== 'get') words.push('-X', method.toUpperCase());
  words.push(`'${location.origin}${target}'`);
  const content = operation.requestBody?.content ?? {};
  const json = content['application/json'];
  if (json) {
    words.push("-H 'Content-Type: application/json'", `-d '${JSON.stringify(json.example)}'`);
  }
  if (content['multipart/form-data']) words.push('-F name=mine', '-F urdf=@robot.urdf');
  return words.join(' ');
}

function answers(operation, resolve) {
  const parts = [];
  for (const [status, raw] of Object.entries(operation.responses)) {
    const response = resolve(raw);
    const [type, media] = Object.entries(response.content ?? {})[0] ?? [];
    const summary = element('summary', {}, element('code', {}, status), ` ${response.description}`);
    const details = element('details', {}, summary);
    if (type) details.append(element('p', { class: 'dim' }, type));
    if (media?.schema) details.append(table(resolve(media.schema), resolve, false));
    parts.push(details);
  }
  return parts;
}

function section(method, path, operation, resolve) {
  const head = element('h3', {}, element('span', { class: 'method' }, method.toUpperCase()), ` ${path}`);
  const made = element('section', { id: operation.operationId }, head);
  made.append(element('p', {}, operation.summary), ...prose(operation.description));
  if (operation.parameters) {
    made.append(element('h4', {}, 'Parameters'), parameters(operation.parameters, resolve));
  }
  for (const [type, media] of Object.entries(operation.requestBody?.content ?? {})) {
    made.append(element('h4', {}, `Body: ${type}`), table(resolve(media.schema), resolve, true));
  }
  made.append(element('h4', {}, 'Answers'), ...answers(operation, resolve));
  made.append(element('pre', {}, curl(method, path, operation, resolve)));
  return made;
}

function render(document_) {
  const resolve = resolver(document_);
  const contents = document.getElementById('contents');
  const main = document.getElementById('api');
  const { info } = document_;
  contents.append(element('a', { href: '/' }, 'Dashboard'));
  contents.append(element('a', { href: '/openapi.json' }, 'openapi.json'));
  main.replaceChildren(element('h1', {}, `${info.title} ${info.version}`), ...prose(info.description));
  for (const tag of document_.tags) {
    const list = element('ul');
    contents.append(element('h2', {}, tag.name), list);
    main.append(element('h2', {}, tag.name), ...prose(tag.description));
    for (const [path, item] of Object.entries(document_.paths)) {
      for (const method of methods.filter((name) => item[name]?.tags.includes(tag.name))) {
        const operation = item[method];
        main.append(section(method, path, operation, resolve));
        const link = element('a', { href: `#${operation.operationId}` }, operation.summary);
        list.append(element('li', {}, link));
      }
    }
  }
  main.setAttribute('aria-busy', 'false');
  document.getElementById(location.hash.slice(1))?.scrollIntoView();
}

try {
  const answer = await fetch('/openapi.json');
  if (!answer.ok) throw new Error(`the server answered ${answer.status}`);
  render(await answer.json());
} catch (error) {
  document.getElementById('status').textContent = `The description cannot be shown: ${error.message}`;
}
